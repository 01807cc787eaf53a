#include "core/processes/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "core/processes/processes.h"

namespace citymesh {
namespace {

using nlohmann::json;

constexpr double kDegree_km = 111.2;  // of a great circle
constexpr double kKm2_m2 = 1e6;

/// A CRS in which a request names places, and whether its axes come latitude first.
struct RequestCrs {
  Crs crs{};
  CrsFacts facts{};
  /// OGC: a place has the axis order of its CRS, and geographic EPSG CRSs are latitude first.
  bool latitude_first = false;
};

Result<RequestCrs> request_crs(std::string_view input, const json& name) {
  auto crs = parse_crs(name.get<std::string>());
  if (!crs) return crs.error();
  auto facts = describe_crs(*crs);
  if (!facts)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("input `{}`: {}", input, facts.error().message));
  const bool latitude_first = facts->geographic && crs->id.starts_with("EPSG:");
  return RequestCrs{*std::move(crs), *std::move(facts), latitude_first};
}

/// @param area in squares of the CRS's unit
/// @param middle_y of what has the area
double in_km2(double area, double middle_y, const CrsFacts& facts) {
  if (!facts.geographic) return area * facts.horizontal_unit_m * facts.horizontal_unit_m / kKm2_m2;
  return area * kDegree_km * kDegree_km *
         std::max(0.0, std::cos(middle_y * std::numbers::pi / 180));
}

Result<void> read_bbox(const json& bbox, Inputs& inputs) {
  const auto named = request_crs("bbox", bbox["crs"]);
  if (!named) return named.error();
  const auto numbers = bbox["bbox"].get<std::vector<double>>();
  const std::size_t half = numbers.size() / 2;
  RequestBox box{numbers[0], numbers[1], numbers[half], numbers[half + 1], {}, named->crs};
  if (named->latitude_first) {
    std::swap(box.min_x, box.min_y);
    std::swap(box.max_x, box.max_y);
  }
  if (half == 3) box.z_range_m = {numbers[2], numbers[5]};
  inputs.area_km2 = in_km2((box.max_x - box.min_x) * (box.max_y - box.min_y),
                           (box.min_y + box.max_y) / 2, named->facts);
  inputs.query.bbox = std::move(box);
  return {};
}

/// Twice the area of a ring.
double doubled_area(const std::vector<std::array<double, 2>>& ring) {
  double sum = 0;
  const auto& [ox, oy] = ring.front();
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    sum += (ring[j][0] - ox) * (ring[i][1] - oy) - (ring[i][0] - ox) * (ring[j][1] - oy);
  return std::abs(sum);
}

Result<void> read_polygon(const json& polygon, Inputs& inputs) {
  if (inputs.query.bbox)
    return fail(ErrorCode::InvalidArgument,
                "inputs `bbox` and `polygon` are both given, expected one of them");
  const auto named = request_crs("polygon", polygon["coordRefSys"]);
  if (!named) return named.error();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RequestBox box{kInfinity, kInfinity, -kInfinity, -kInfinity, {}, named->crs};
  const json& coordinates = polygon["coordinates"];
  double doubled = 0;
  for (const json& rings :
       polygon["type"] == "Polygon" ? json::array({coordinates}) : coordinates) {
    double sign = 1;  // the first ring has the area, the others take from it
    for (const json& given : rings) {
      auto& ring = box.rings.emplace_back();
      for (std::size_t i = 0; i + 1 < given.size(); ++i) {
        auto& [x, y] = ring.emplace_back();
        x = given[i][0].get<double>();
        y = given[i][1].get<double>();
        if (named->latitude_first) std::swap(x, y);
        box.min_x = std::min(box.min_x, x);
        box.min_y = std::min(box.min_y, y);
        box.max_x = std::max(box.max_x, x);
        box.max_y = std::max(box.max_y, y);
      }
      doubled += sign * doubled_area(ring);
      sign = -1;
    }
  }
  inputs.area_km2 = in_km2(std::max(0.0, doubled / 2), (box.min_y + box.max_y) / 2, named->facts);
  inputs.query.bbox = std::move(box);
  return {};
}

/// Of what complete_inputs() has passed.
Result<Inputs> read_inputs(std::string_view canonical_json) {
  const json given = json::parse(canonical_json);
  Inputs inputs;
  inputs.only_estimate = given.value("mode", "run") == "estimate";
  if (const auto bbox = given.find("bbox"); bbox != given.end() && !bbox->is_null())
    if (auto read = read_bbox(*bbox, inputs); !read) return read.error();
  if (const auto polygon = given.find("polygon"); polygon != given.end() && !polygon->is_null())
    if (auto read = read_polygon(*polygon, inputs); !read) return read.error();
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
