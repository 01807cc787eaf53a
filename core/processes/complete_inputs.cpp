#include "core/processes/processes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/citymodel/crs.h"

namespace citymesh {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxShownBytes = 80;
constexpr std::size_t kMaxInputBytes = 8u << 20;
constexpr std::size_t kMaxDepth = 16;
constexpr std::size_t kMaxPositions = 10'000;  ///< every building may be compared with each side
constexpr const char* kCrs84 = "http://www.opengis.net/def/crs/OGC/1.3/CRS84";

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
    checked["crs"] = kCrs84;
  }
  return checked;
}

std::size_t positions_of(const json& coordinates) {
  if (!coordinates.is_array() || coordinates.empty() || coordinates[0].is_number()) return 1;
  std::size_t count = 0;
  for (const json& member : coordinates) count += positions_of(member);
  return count;
}

bool is_position(const json& value) {
  return value.is_array() && (value.size() == 2 || value.size() == 3) &&
         std::all_of(value.begin(), value.end(), [](const json& number) {
           return number.is_number() && std::isfinite(number.get<double>());
         });
}

/// What is wrong with the rings of a GeoJSON Polygon; empty: nothing.
std::string_view problem_of_rings(const json& rings) {
  if (!rings.is_array() || rings.empty()) return "`coordinates` with at least one ring";
  for (const json& ring : rings) {
    if (!ring.is_array() || ring.size() < 4) return "rings of at least four positions";
    if (!std::all_of(ring.begin(), ring.end(), is_position))
      return "positions of two or three finite numbers";
    if (ring.front() != ring.back()) return "rings that end where they begin";
  }
  return {};
}

Result<json> check_polygon(const json& value) {
  if (!value.is_object() || !value.contains("coordinates") ||
      (value.value("type", json()) != "Polygon" && value.value("type", json()) != "MultiPolygon"))
    return wrong("polygon", value, "a GeoJSON Polygon or MultiPolygon");
  for (const auto& [key, member] : value.items())
    if (key != "type" && key != "coordinates" && key != "coordRefSys")
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("input `polygon` has an unknown member `{}`, expected type, "
                              "coordinates, coordRefSys",
                              key));
  const json& coordinates = value["coordinates"];
  const json polygons = value["type"] == "Polygon" ? json::array({coordinates}) : coordinates;
  if (!polygons.is_array() || polygons.empty())
    return wrong("polygon", value, "`coordinates` with at least one polygon");
  for (const json& rings : polygons)
    if (const auto problem = problem_of_rings(rings); !problem.empty())
      return wrong("polygon", value, problem);
  if (const auto positions = positions_of(coordinates); positions > kMaxPositions)
    return fail(
        ErrorCode::ResourceExhausted,
        fmt::format("input `polygon` has {} positions, the limit is {}", positions, kMaxPositions));
  const json crs = value.value("coordRefSys", json(kCrs84));
  if (!crs.is_string()) return wrong("polygon", value, "`coordRefSys` to be a text");
  if (auto known = parse_crs(crs.get<std::string>()); !known)
    return fail(ErrorCode::InvalidArgument, "input `polygon`: " + known.error().message);
  return json{{"type", value["type"]}, {"coordinates", coordinates}, {"coordRefSys", crs}};
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
    case OptionKind::Polygon:
      return check_polygon(value);
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

}  // namespace citymesh
