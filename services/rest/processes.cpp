#include "services/rest/processes.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/version.h"
#include "services/offer/offer.h"
#include "services/rest/links.h"

namespace citymesh {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kCrs84 = "http://www.opengis.net/def/crs/OGC/1.3/CRS84";

Json text_schema(const OptionSpec& option) {
  Json schema = {{"type", "string"}};
  if (!option.choices.empty()) schema["enum"] = option.choices;
  return schema;
}

Json bbox_schema() {
  return {
      {"allOf",
       {{{"format", "ogc-bbox"}},
        {{"type", "object"},
         {"required", {"bbox"}},
         {"additionalProperties", false},
         {"properties",
          {{"bbox",
            {{"type", "array"},
             {"oneOf", {{{"minItems", 4}, {"maxItems", 4}}, {{"minItems", 6}, {"maxItems", 6}}}},
             {"items", {{"type", "number"}}}}},
           {"crs", {{"type", "string"}, {"default", kCrs84}}}}}}}}};
}

Json polygon_schema() {
  return {{"type", "object"},
          {"required", {"type", "coordinates"}},
          {"additionalProperties", false},
          {"properties",
           {{"type", {{"type", "string"}, {"enum", {"Polygon", "MultiPolygon"}}}},
            {"coordinates",
             {{"type", "array"},
              {"minItems", 1},
              {"items", {{"type", "array"}, {"items", Json::object()}}}}},
            {"coordRefSys", {{"type", "string"}, {"default", kCrs84}}}}}};
}

Json kind_schema(const OptionSpec& option) {
  if (!option.schema_json.empty()) return Json::parse(option.schema_json);
  switch (option.kind) {
    case OptionKind::Boolean:
      return {{"type", "boolean"}};
    case OptionKind::Integer:
      return {{"type", "integer"}};
    case OptionKind::Number:
      return {{"type", "number"}};
    case OptionKind::Text:
      return text_schema(option);
    case OptionKind::TextList:
      return {{"type", "array"}, {"items", text_schema(option)}};
    case OptionKind::BoundingBox:
      return bbox_schema();
    case OptionKind::Polygon:
      return polygon_schema();
    case OptionKind::Json:
      break;
  }
  return Json::object();
}

Json schema_of(const OptionSpec& option) {
  auto schema = kind_schema(option);
  if (option.minimum < option.maximum) {
    schema["minimum"] = option.minimum;
    schema["maximum"] = option.maximum;
  }
  const auto fallback = Json::parse(option.default_json, nullptr, false);
  if (!fallback.is_discarded() && !fallback.is_null()) schema["default"] = fallback;
  return schema;
}

/// `snap_tolerance_m` reads "Snap tolerance m".
std::string title_of(std::string_view name) {
  std::string title(name);
  std::ranges::replace(title, '_', ' ');
  if (!title.empty() && title.front() >= 'a' && title.front() <= 'z')
    title.front() = static_cast<char>(title.front() - 'a' + 'A');
  return title;
}

Json output_schema(const OutputSpec& output) {
  if (!output.schema_json.empty()) {
    auto schema = Json::parse(output.schema_json);
    schema["contentMediaType"] = output.media_type;
    return schema;
  }
  return {{"type", is_json(output) ? "object" : "string"}, {"contentMediaType", output.media_type}};
}

std::string process_url(std::string_view base, const ProcessSpec& process) {
  return fmt::format("{}/processes/{}", base, process.id);
}

Json summary(std::string_view base, const ProcessSpec& process) {
  const auto self = process_url(base, process);
  const Json control = process.async_only ? Json{"async-execute", "dismiss"}
                                          : Json{"sync-execute", "async-execute", "dismiss"};
  return {{"id", process.id},
          {"version", version()},
          {"title", process.title},
          {"description", process.description},
          {"jobControlOptions", control},
          {"outputTransmission", {"value", "reference"}},
          {"links",
           {link_json<Json>(self, "self", "application/json", "Process description"),
            link_json<Json>(self, "alternate", "text/html", "Process description as a page"),
            link_json<Json>(self + "/execution", rel::kExecute, "application/json",
                            "Execution endpoint")}}};
}

}  // namespace

bool is_json(const OutputSpec& output) {
  return output.media_type == "application/json" || output.media_type.ends_with("+json");
}

std::string process_list_json(std::string_view base, std::size_t limit, std::size_t offset) {
  const auto all = offered_processes();
  const auto begin = std::min(offset, all.size());
  const auto end = begin + std::min(limit, all.size() - begin);

  Json list = Json::array();
  for (const auto& process : all.subspan(begin, end - begin))
    list.push_back(summary(base, process));
  const auto self = fmt::format("{}/processes", base);
  Json links = {link_json<Json>(self, "self", "application/json", "Processes"),
                link_json<Json>(self, "alternate", "text/html", "Processes as a page")};
  if (end < all.size())
    links.push_back(link_json<Json>(fmt::format("{}?limit={}&offset={}", self, limit, end), "next",
                                    "application/json", "Next page"));
  return dump(Json{{"processes", std::move(list)}, {"links", std::move(links)}});
}

std::string process_description_json(std::string_view base, const ProcessSpec& process) {
  auto description = summary(base, process);
  auto& inputs = description["inputs"] = Json::object();
  for (const auto& option : process.inputs)
    inputs[std::string(option.name)] = {{"title", title_of(option.name)},
                                        {"description", option.description},
                                        {"minOccurs", 0},
                                        {"schema", schema_of(option)}};
  auto& outputs = description["outputs"] = Json::object();
  for (const auto& output : process.outputs)
    outputs[std::string(output.id)] = {{"title", output.title}, {"schema", output_schema(output)}};
  return dump(description);
}

std::string inputs_schema_json(const ProcessSpec& process) {
  Json properties = Json::object();
  for (const auto& option : process.inputs) {
    auto plain = schema_of(option);
    for (const auto* newer : {"contentMediaType", "contentEncoding"})  // than OpenAPI 3.0
      plain.erase(newer);
    auto& input = properties[std::string(option.name)] = {{"description", option.description}};
    if (plain.contains("default")) {
      input["default"] = plain["default"];
      plain.erase("default");
    }
    // OGC: an object is wrapped as {"value": {...}}, but for a bounding box.
    const bool wrapped = (option.kind == OptionKind::Json || option.kind == OptionKind::Polygon) &&
                         plain.value("type", "") == "object" &&
                         plain.value("format", "") != "ogc-bbox";
    input["oneOf"] = Json::array({Json{{"$ref", "#/components/schemas/qualifiedValue"}}});
    if (!wrapped) input["oneOf"].insert(input["oneOf"].begin(), std::move(plain));
  }
  return dump(Json{
      {"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}});
}

std::string example_request_json(const ProcessSpec& process) {
  Json inputs = Json::object();
  for (const auto& option : process.inputs)
    if (option.kind == OptionKind::BoundingBox)
      inputs[std::string(option.name)] = {{"bbox", {13.40, 52.51, 13.41, 52.52}}, {"crs", kCrs84}};
    else if (option.name == "formats")
      inputs["formats"] = Json::parse(option.default_json, nullptr, false);
  if (inputs.empty() && !process.inputs.empty() && process.inputs.front().kind == OptionKind::Text)
    inputs[std::string(process.inputs.front().name)] = "hello";
  return dump(Json{{"inputs", std::move(inputs)}});
}

}  // namespace citymesh
