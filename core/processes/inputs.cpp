#include "core/processes/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/processes/processes.h"

namespace citymesh {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxShownBytes = 80;
constexpr std::size_t kMaxInputBytes = 8u << 20;
constexpr std::size_t kMaxDepth = 16;

std::string shown(const json& value) {
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > kMaxShownBytes) text = text.substr(0, kMaxShownBytes) + "…";
  return text;
}

Error wrong(std::string_view name, const json& value, std::string_view expected) {
  return fail(ErrorCode::InvalidArgument,
              fmt::format("input `{}` is {}, expected {}", name, shown(value), expected));
}

std::string listed(std::span<const std::string_view> choices) {
  return fmt::format("one of {}", fmt::join(choices, ", "));
}

bool allowed(const OptionSpec& option, const std::string& text) {
  return option.choices.empty() ||
         std::find(option.choices.begin(), option.choices.end(), text) != option.choices.end();
}

Result<json> check_bbox(const json& value) {
  constexpr std::string_view kForm =
      "an object {\"bbox\": [minx, miny, maxx, maxy] or 6 numbers, \"crs\": uri}";
  if (!value.is_object() || !value.contains("bbox")) return wrong("bbox", value, kForm);
  for (const auto& [key, member] : value.items())
    if (key != "bbox" && key != "crs")
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("input `bbox` has an unknown member `{}`, expected {}", key, kForm));
  const json& numbers = value["bbox"];
  if (!numbers.is_array() || (numbers.size() != 4 && numbers.size() != 6))
    return wrong("bbox", value, kForm);
  for (const json& number : numbers)
    if (!number.is_number() || !std::isfinite(number.get<double>()))
      return wrong("bbox", value, "finite numbers");
  const std::size_t half = numbers.size() / 2;
  for (std::size_t i = 0; i < half; ++i)
    if (numbers[i].get<double>() > numbers[i + half].get<double>())
      return wrong("bbox", value, fmt::format("minimum not above maximum on axis {}", i + 1));
  json checked{{"bbox", numbers}};
  if (value.contains("crs")) {
    if (!value["crs"].is_string()) return wrong("bbox", value, "`crs` to be a text");
    auto crs = parse_crs(value["crs"].get<std::string>());
    if (!crs) return fail(ErrorCode::InvalidArgument, "input `bbox`: " + crs.error().message);
    checked["crs"] = value["crs"];
  } else {
    checked["crs"] = "http://www.opengis.net/def/crs/OGC/1.3/CRS84";
  }
  return checked;
}

Result<json> check(const OptionSpec& option, const json& value) {
  if (value.is_null() && option.default_json == "null") return value;
  switch (option.kind) {
    case OptionKind::Boolean:
      if (!value.is_boolean()) return wrong(option.name, value, "true or false");
      return value;
    case OptionKind::Integer:
    case OptionKind::Number: {
      const bool fits =
          option.kind == OptionKind::Integer ? value.is_number_integer() : value.is_number();
      if (!fits)
        return wrong(option.name, value,
                     option.kind == OptionKind::Integer ? "a whole number" : "a number");
      const double number = value.get<double>();
      const bool limited = option.minimum < option.maximum;
      if (!std::isfinite(number) ||
          (limited && (number < option.minimum || number > option.maximum)))
        return wrong(option.name, value,
                     fmt::format("a number from {} to {}", option.minimum, option.maximum));
      return value;
    }
    case OptionKind::Text:
      if (!value.is_string()) return wrong(option.name, value, "a text");
      if (!allowed(option, value.get<std::string>()))
        return wrong(option.name, value, listed(option.choices));
      return value;
    case OptionKind::TextList: {
      // A single text stands for a list of one: what a form or a command line sends.
      const json list = value.is_string() ? json::array({value}) : value;
      if (!list.is_array()) return wrong(option.name, value, "a list of texts");
      json unique = json::array();
      for (const json& item : list) {
        if (!item.is_string()) return wrong(option.name, value, "a list of texts");
        if (!allowed(option, item.get<std::string>()))
          return wrong(option.name, item, listed(option.choices));
        if (std::find(unique.begin(), unique.end(), item) == unique.end()) unique.push_back(item);
      }
      return unique;
    }
    case OptionKind::BoundingBox:
      return check_bbox(value);
    case OptionKind::Json:
      return value;
  }
  return value;
}

/// Parses with our own bounds on size and depth; the position of an error is part of the message.
Result<json> parse_object(std::string_view text) {
  if (text.size() > kMaxInputBytes)
    return fail(ErrorCode::ResourceExhausted,
                fmt::format("inputs have {} bytes, the limit is {}", text.size(), kMaxInputBytes));
  std::size_t depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
    } else if (c == '"')
      in_string = true;
    else if (c == '{' || c == '[')
      deepest = std::max(deepest, ++depth);
    else if ((c == '}' || c == ']') && depth > 0)
      --depth;
  }
  if (deepest > kMaxDepth)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("inputs are nested {} deep, the limit is {}", deepest, kMaxDepth));
  try {
    json value = json::parse(text);
    if (!value.is_object())
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("inputs are {}, expected a JSON object", shown(value)));
    return value;
  } catch (const json::exception& error) {
    return fail(ErrorCode::InvalidArgument,
                fmt::format("inputs are not valid JSON: {}", error.what()));
  }
}

}  // namespace

Result<std::string> canonical_inputs(std::string_view process, std::string_view inputs_json) {
  const ProcessSpec* spec = find_process(process);
  if (!spec)
    return fail(ErrorCode::NotFound,
                fmt::format("process `{}` does not exist; available: {}", process, process_ids()));
  auto text = complete_inputs(*spec, inputs_json);
  if (!text) return text;
  if (auto readable = read_inputs(*text); !readable) return readable.error();
  return text;
}

Result<std::string> complete_inputs(const ProcessSpec& process, std::string_view inputs_json) {
  auto given = parse_object(inputs_json.empty() ? "{}" : inputs_json);
  if (!given) return given.error();

  json canonical = json::object();
  for (const OptionSpec& option : process.inputs) {
    const auto found = given->find(std::string(option.name));
    auto value = found == given->end() ? Result<json>(json::parse(option.default_json))
                                       : check(option, *found);
    if (!value) return value.error();
    canonical[std::string(option.name)] = std::move(*value);
  }
  for (const auto& [name, value] : given->items())
    if (!canonical.contains(name)) {
      std::vector<std::string_view> known;
      for (const OptionSpec& option : process.inputs) known.push_back(option.name);
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("input `{}` does not exist for {}; available: {}", name, process.id,
                              fmt::join(known, ", ")));
    }
  return canonical.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<Inputs> read_inputs(std::string_view canonical_json) {
  const json given = json::parse(canonical_json);
  Inputs inputs;
  inputs.only_estimate = given.value("mode", "run") == "estimate";
  if (const auto bbox = given.find("bbox"); bbox != given.end() && !bbox->is_null()) {
    auto crs = parse_crs((*bbox)["crs"].get<std::string>());
    if (!crs) return crs.error();
    auto facts = describe_crs(*crs);
    if (!facts) return fail(ErrorCode::InvalidArgument, "input `bbox`: " + facts.error().message);
    const auto numbers = (*bbox)["bbox"].get<std::vector<double>>();
    const std::size_t half = numbers.size() / 2;
    RequestBox box{numbers[0], numbers[1], numbers[half], numbers[half + 1], {}, *crs};
    // OGC: a box has the axis order of its CRS, and geographic EPSG CRSs are latitude first.
    if (facts->geographic && crs->id.starts_with("EPSG:")) {
      std::swap(box.min_x, box.min_y);
      std::swap(box.max_x, box.max_y);
    }
    if (half == 3) box.z_range_m = {numbers[2], numbers[5]};
    inputs.query.bbox = box;
  }
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
  inputs.keep_installations = given.value("installations", "drop") == "keep";
  return inputs;
}

}  // namespace citymesh
