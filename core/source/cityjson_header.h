#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/source/feature.h"

namespace simdjson::dom {
class element;
class object;
}  // namespace simdjson::dom

namespace citymesh::source {

/// What a CityJSON document says before its objects.
struct CityJsonHeader {
  std::array<double, 3> scale{1, 1, 1};
  std::array<double, 3> translate{0, 0, 0};
  std::uint32_t srs = 0;
  Feature templates{};  ///< an object for each geometry template

  Point3 place(double x, double y, double z) const {
    return {x * scale[0] + translate[0], y * scale[1] + translate[1], z * scale[2] + translate[2]};
  }
};

/// The first failure of a document counts.
void note_failure(DocumentFacts& facts, std::string reason);

std::optional<std::string_view> text_member(const simdjson::dom::object& object,
                                            std::string_view key);
std::optional<double> finite_number(const simdjson::dom::element& element);

/// Each returns what is wrong, or "". `transform`: nullptr when there is none.
std::string read_type_and_version(std::optional<std::string_view> type,
                                  std::optional<std::string_view> version, bool sequence,
                                  DocumentFacts& facts);
std::string read_transform(const simdjson::dom::element* transform, const DocumentFacts& facts,
                           CityJsonHeader& header);

void read_metadata(const simdjson::dom::element& element, DocumentFacts& facts,
                   CityJsonHeader& header);

}  // namespace citymesh::source
