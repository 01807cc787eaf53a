#include "services/apps/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace citymesh {
namespace {

using nlohmann::json;

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

Result<json> bbox_object(std::string_view text) {
  const auto refuse = [&] {
    return fail(ErrorCode::InvalidArgument,
                fmt::format("bbox is '{}', expected minx,miny,maxx,maxy or "
                            "minx,miny,minz,maxx,maxy,maxz, then perhaps @CRS",
                            text));
  };
  const auto at = text.find('@');
  auto numbers = json::array();
  for (const auto part : split(text.substr(0, at), ',')) {
    const auto value = number(part);
    if (!value) return refuse();
    numbers.push_back(*value);
  }
  if (numbers.size() != 4 && numbers.size() != 6) return refuse();
  json box{{"bbox", numbers}};
  if (at != std::string_view::npos) {
    if (at + 1 == text.size()) return refuse();
    box["crs"] = text.substr(at + 1);
  }
  return box;
}

/// JSON as such, or nothing when the text is none of the wanted type.
std::optional<json> as_json(std::string_view text, json::value_t wanted) {
  auto value = json::parse(text, nullptr, false);
  if (value.is_discarded() || value.type() != wanted) return std::nullopt;
  return value;
}

/// The value of `--set`. Text that does not fit stays text: canonical_inputs() says what is wrong.
Result<json> typed(const OptionSpec* option, std::string_view text) {
  if (option == nullptr) return json(text);
  switch (option->kind) {
    case OptionKind::Boolean:
      return as_json(text, json::value_t::boolean).value_or(json(text));
    case OptionKind::Integer:
    case OptionKind::Number: {
      auto value = json::parse(text, nullptr, false);
      return value.is_number() ? value : json(text);
    }
    case OptionKind::Text:
      return as_json(text, json::value_t::string).value_or(json(text));
    case OptionKind::TextList: {
      if (text.starts_with('[')) return as_json(text, json::value_t::array).value_or(json(text));
      auto list = json::array();
      if (!text.empty())
        for (const auto part : split(text, ',')) list.push_back(part);
      return list;
    }
    case OptionKind::BoundingBox:
      if (text.starts_with('{')) return as_json(text, json::value_t::object).value_or(json(text));
      return bbox_object(text);
    case OptionKind::Polygon:
    case OptionKind::Json: {
      auto value = json::parse(text, nullptr, false);
      return value.is_discarded() ? json(text) : value;
    }
  }
  return json(text);
}

Result<void> put(json& inputs, std::string_view name, json value) {
  const auto [where, added] = inputs.emplace(std::string(name), std::move(value));
  if (!added)
    return fail(ErrorCode::InvalidArgument, fmt::format("input `{}` is given twice", name));
  return {};
}

}  // namespace

Result<std::string> bbox_json(std::string_view text) {
  const auto box = bbox_object(text);
  if (!box) return box.error();
  return box->dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<CanonicalInputs> inputs_of(const ProcessSpec& process, const InputArguments& arguments) {
  auto inputs = json::object();
  if (!arguments.formats.empty()) inputs["formats"] = arguments.formats;
  if (!arguments.bbox.empty()) {
    auto box = bbox_object(arguments.bbox);
    if (!box) return box.error();
    if (auto added = put(inputs, "bbox", *std::move(box)); !added) return added.error();
  }
  for (const auto& setting : arguments.settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("--set '{}' has no value, expected name=value", setting));
    const auto name = std::string_view(setting).substr(0, equals);
    const auto option = std::ranges::find(process.inputs, name, &OptionSpec::name);
    auto value = typed(option == process.inputs.end() ? nullptr : &*option,
                       std::string_view(setting).substr(equals + 1));
    if (!value) return value.error();
    if (auto added = put(inputs, name, *std::move(value)); !added) return added.error();
  }
  return canonical_inputs(process.id, inputs.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace citymesh
