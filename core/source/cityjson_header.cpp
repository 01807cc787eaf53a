#include "core/source/cityjson_header.h"

#include <simdjson.h>

#include <cmath>
#include <utility>

namespace citymesh::source {
namespace {

namespace dom = simdjson::dom;

bool read_three(dom::object transform, std::string_view key, std::array<double, 3>& values) {
  dom::array list;
  if (transform[key].get(list) != simdjson::SUCCESS || list.size() != 3) return false;
  std::size_t i = 0;
  for (const dom::element element : list) {
    const auto value = finite_number(element);
    if (!value) return false;
    values[i++] = *value;
  }
  return true;
}

}  // namespace

void note_failure(DocumentFacts& facts, std::string reason) {
  if (facts.failure.empty()) facts.failure = std::move(reason);
}

std::optional<std::string_view> text_member(const dom::object& object, std::string_view key) {
  std::string_view text;
  if (object[key].get(text) != simdjson::SUCCESS) return std::nullopt;
  return text;
}

std::optional<double> finite_number(const dom::element& element) {
  double value = 0;
  if (element.get(value) != simdjson::SUCCESS || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string read_type_and_version(std::optional<std::string_view> type,
                                  std::optional<std::string_view> version, bool sequence,
                                  DocumentFacts& facts) {
  facts.not_a_city_model = type != "CityJSON";
  if (facts.not_a_city_model)
    return "member 'type' is '" + std::string(type.value_or("missing")) + "', expected 'CityJSON'";
  if (!version)
    return "member 'version' is missing or no text, expected \"1.0\", \"1.1\" or \"2.0\"";
  const auto known = version->substr(0, 3);
  if (known != "1.0" && known != "1.1" && known != "2.0")
    return "CityJSON version '" + std::string(version->substr(0, 20)) +
           "' is not read, expected 1.0, 1.1 or 2.0";
  facts.format = std::string(sequence ? "CityJSONSeq " : "CityJSON ") + std::string(known);
  return {};
}

std::string read_transform(const dom::element* element, const DocumentFacts& facts,
                           CityJsonHeader& header) {
  if (!element) {
    if (facts.format == "CityJSON 1.0") return {};
    return "member 'transform' is missing, " + facts.format + " requires it";
  }
  dom::object transform;
  if (element->get(transform) != simdjson::SUCCESS ||
      !read_three(transform, "scale", header.scale) ||
      !read_three(transform, "translate", header.translate))
    return "member 'transform' must have 'scale' and 'translate' with three numbers each";
  return {};
}

void read_metadata(const dom::element& element, DocumentFacts& facts, CityJsonHeader& header) {
  dom::object metadata;
  if (element.get(metadata) != simdjson::SUCCESS) return;
  dom::object old_crs;
  std::int64_t old_code = 0;
  if (const auto name = text_member(metadata, "referenceSystem"))
    header.srs = facts.intern_srs(*name);
  else if (metadata["crs"].get(old_crs) == simdjson::SUCCESS &&
           old_crs["epsg"].get(old_code) == simdjson::SUCCESS && old_code > 0)
    header.srs = facts.intern_srs("EPSG:" + std::to_string(old_code));
  dom::array extent;
  if (metadata["geographicalExtent"].get(extent) != simdjson::SUCCESS || extent.size() != 6) return;
  std::array<double, 6> values{};
  std::size_t i = 0;
  for (const dom::element value : extent) {
    const auto number = finite_number(value);
    if (!number) return;
    values[i++] = *number;
  }
  facts.declared_extent.add(Point3{values[0], values[1], values[2]});
  facts.declared_extent.add(Point3{values[3], values[4], values[5]});
  facts.declared_srs = header.srs;
}

}  // namespace citymesh::source
