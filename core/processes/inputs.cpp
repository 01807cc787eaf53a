#include "core/processes/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "core/processes/processes.h"

namespace citymesh {
namespace {

using nlohmann::json;

constexpr double kDegree_km = 111.2;  // of a great circle
constexpr double kKm2_m2 = 1e6;

double area_km2(const RequestBox& box, const CrsFacts& facts) {
  const double width = std::abs(box.max_x - box.min_x);
  const double height = std::abs(box.max_y - box.min_y);
  if (!facts.geographic)
    return width * height * facts.horizontal_unit_m * facts.horizontal_unit_m / kKm2_m2;
  const double middle = (box.min_y + box.max_y) / 2 * std::numbers::pi / 180;
  return width * height * kDegree_km * kDegree_km * std::max(0.0, std::cos(middle));
}

Result<void> read_bbox(const json& bbox, Inputs& inputs) {
  const auto crs = parse_crs(bbox["crs"].get<std::string>());
  if (!crs) return crs.error();
  const auto facts = describe_crs(*crs);
  if (!facts) return fail(ErrorCode::InvalidArgument, "input `bbox`: " + facts.error().message);
  const auto numbers = bbox["bbox"].get<std::vector<double>>();
  const std::size_t half = numbers.size() / 2;
  RequestBox box{numbers[0], numbers[1], numbers[half], numbers[half + 1], {}, *crs};
  // OGC: a box has the axis order of its CRS, and geographic EPSG CRSs are latitude first.
  if (facts->geographic && crs->id.starts_with("EPSG:")) {
    std::swap(box.min_x, box.min_y);
    std::swap(box.max_x, box.max_y);
  }
  if (half == 3) box.z_range_m = {numbers[2], numbers[5]};
  inputs.query.bbox = box;
  inputs.bbox_area_km2 = area_km2(box, *facts);
  return {};
}

/// Of what complete_inputs() has passed.
Result<Inputs> read_inputs(std::string_view canonical_json) {
  const json given = json::parse(canonical_json);
  Inputs inputs;
  inputs.only_estimate = given.value("mode", "run") == "estimate";
  if (const auto bbox = given.find("bbox"); bbox != given.end() && !bbox->is_null())
    if (auto read = read_bbox(*bbox, inputs); !read) return read.error();
  const std::string rule = given.value("bbox_rule", "intersects");
  inputs.query.bbox_rule = rule == "centre"   ? BboxRule::Centre
                           : rule == "within" ? BboxRule::Within
                                              : BboxRule::Intersects;
  inputs.query.object_ids = given.value("object_ids", std::vector<std::string>{});
  if (const std::string name = given.value("crs", ""); !name.empty()) {
    auto crs = parse_crs(name);
    if (!crs) return fail(ErrorCode::InvalidArgument, "input `crs`: " + crs.error().message);
    auto facts = describe_crs(*crs);
    if (!facts) return fail(ErrorCode::InvalidArgument, "input `crs`: " + facts.error().message);
    if (facts->geographic)
      return fail(
          ErrorCode::InvalidArgument,
          fmt::format(
              "input `crs` is {}, a geographic CRS in degrees; expected a projected CRS in metres",
              name));
    inputs.query.crs = *crs;
  }
  if (const std::string name = given.value("source_crs", ""); !name.empty()) {
    auto crs = parse_crs(name);
    if (!crs) return fail(ErrorCode::InvalidArgument, "input `source_crs`: " + crs.error().message);
    if (crs->known())
      if (auto facts = describe_crs(*crs); !facts)
        return fail(ErrorCode::InvalidArgument, "input `source_crs`: " + facts.error().message);
    inputs.query.source_crs = *crs;
  }
  const std::string order = given.value("axis_order", "auto");
  inputs.query.axis_order = order == "east_north"   ? AxisOrder::EastNorth
                            : order == "north_east" ? AxisOrder::NorthEast
                                                    : AxisOrder::Auto;
  for (const std::string& text : given.value("lod", std::vector<std::string>{})) {
    const auto lod = lod_from(text);
    if (!lod)
      return fail(
          ErrorCode::InvalidArgument,
          fmt::format("input `lod` has \"{}\", expected levels such as \"2\" or \"2.2\"", text));
    inputs.lod.push_back(*lod);
  }
  if (given.contains("lod") && inputs.lod.empty())
    return fail(ErrorCode::InvalidArgument,
                "input `lod` is an empty list, expected at least one level");
  inputs.formats = given.value("formats", std::vector<std::string>{});
  inputs.block_on_failure = given.value("on_failure", "block") == "block";
  inputs.patches =
      given.value("patches", "by_object") == "by_type" ? Patches::ByType : Patches::ByObject;
  inputs.snap_tolerance_m = given.value("snap_tolerance_m", inputs.snap_tolerance_m);
  inputs.gap_threshold_m = given.value("gap_threshold_m", inputs.gap_threshold_m);
  inputs.planarity_tolerance_m = given.value("planarity_tolerance_m", inputs.planarity_tolerance_m);
  inputs.max_displacement_m = given.value("max_displacement_m", inputs.max_displacement_m);
  inputs.max_hole_area_m2 = given.value("max_hole_area_m2", inputs.max_hole_area_m2);
  inputs.merge_parts = given.value("parts", "keep") == "merge";
  if (given.value("unite_neighbours", false))
    return fail(ErrorCode::Unimplemented,
                "input `unite_neighbours` is true: uniting is not built, expected false");
  inputs.write_back = given.value("write_back", false);
  inputs.keep_installations = given.value("installations", "drop") == "keep";
  return inputs;
}

}  // namespace

Result<CanonicalInputs> canonical_inputs(std::string_view process, std::string_view inputs_json) {
  const ProcessSpec* spec = find_process(process);
  if (!spec)
    return fail(ErrorCode::NotFound,
                fmt::format("process `{}` does not exist; available: {}", process, process_ids()));
  auto text = complete_inputs(*spec, inputs_json);
  if (!text) return text.error();
  auto values = read_inputs(*text);
  if (!values) return values.error();
  return CanonicalInputs{*std::move(text), *std::move(values)};
}

bool asks_to_write_back(std::string_view canonical_json) {
  const auto given = json::parse(canonical_json, nullptr, false);
  const auto found = given.is_object() ? given.find("write_back") : given.end();
  return found != given.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace citymesh
