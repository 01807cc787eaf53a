#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/source/cityjson_header.h"

namespace citymesh::source {

/// Gives the JSON of an object, nullptr where it cannot be read; it lives until the next call.
using LoadObject = std::function<const simdjson::dom::object*(std::uint32_t)>;

/// Ids, types and relations of city objects, numbered in the order in which they are added.
class CityObjects {
 public:
  void add(std::string id, const simdjson::dom::object* object);
  /// When all are added. Joins parents and children: files often state only one of them.
  void link();

 private:
  friend class CityJsonDelivery;
  enum class Type : std::uint8_t { Building, Part, Installation, Extension, Other };
  struct Entry {
    std::string id{};
    Type type = Type::Other;
    std::string extension{};  ///< type of an extension
    std::vector<std::uint32_t> children{};
    bool delivered = false;
  };
  using Relations = std::vector<std::pair<std::uint32_t, std::string>>;

  static Type type_of(const simdjson::dom::object& object);
  static void keep_ids(const simdjson::dom::object& object, std::string_view key,
                       std::uint32_t index, Relations& relations);
  void join(std::uint32_t from, const std::string& id, bool upwards);

  std::vector<Entry> entries_{};
  TextMap<std::uint32_t> by_id_{};
  Relations parents_{};   ///< child, id of its parent
  Relations children_{};  ///< parent, id of its child
  std::set<std::pair<std::uint32_t, std::uint32_t>> linked_{};
};

/// Makes features of city objects: every Building with its parts and installations, then parts
/// without a building. Counts what is passed over.
class CityJsonDelivery {
 public:
  CityJsonDelivery(const DocumentOptions& options, DocumentFacts& facts, const FeatureSink& sink,
                   const CityJsonHeader& header)
      : options_(options), facts_(facts), sink_(sink), header_(header) {}

  /// `bytes`: where the objects stand, if they can be read by themselves. Errors: Cancelled; those
  /// of the sink.
  Result<void> deliver(CityObjects& objects, const std::vector<Point3>& vertices,
                       const LoadObject& load, const ByteRange& bytes = {});

 private:
  Result<void> deliver_one(CityObjects& objects, std::uint32_t root,
                           const std::vector<Point3>& vertices, const LoadObject& load);

  const DocumentOptions& options_;
  DocumentFacts& facts_;
  const FeatureSink& sink_;
  const CityJsonHeader& header_;
  Feature feature_{};
  std::uint64_t ordinal_ = 0;
};

}  // namespace citymesh::source
