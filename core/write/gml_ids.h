#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>

namespace citymesh {

/// Makes a valid xs:ID of any text and leaves valid ones as they are. What is not valid becomes
/// what body names have instead, so that a model read back has the same body names.
std::string to_ncname(std::string_view id);

/// The gml:ids of a file, each given once. Keeps a hash of every id it was asked for; a chance
/// equality of hashes costs an id its original form, nothing else.
class GmlIds {
 public:
  /// The id itself if it is valid and new, else one made from it; `otherwise` for an empty one.
  std::string take(std::string_view id, std::string_view otherwise);

 private:
  bool is_new(std::string_view id);

  std::unordered_set<std::uint64_t> taken_{};
};

/// The ids inside of one body: those of its surfaces, and generated ones `cm.<name>.p12`, which
/// stay clear of them.
class BodyIds {
 public:
  BodyIds(GmlIds& ids, std::string_view name)
      : ids_(ids), prefix_("cm." + std::string(name) + '.') {}

  std::string take(std::string_view id, char kind, std::size_t number);
  std::string generated(char kind, std::size_t number);

 private:
  GmlIds& ids_;
  std::string prefix_;
  std::unordered_set<std::string> own_{};  ///< source ids that look like generated ones
};

}  // namespace citymesh
