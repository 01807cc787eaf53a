#include "services/rest/execute.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/write/write.h"
#include "services/offer/offer.h"

namespace citymesh {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxShownBytes = 80;

std::string shown(const json& value) {
  auto text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > kMaxShownBytes) text = text.substr(0, kMaxShownBytes) + "...";
  return text;
}

Error wrong(std::string_view member, const json& value, std::string_view expected) {
  return fail(ErrorCode::InvalidArgument,
              fmt::format("{} is {}, expected {}", member, shown(value), expected));
}

/// How deep arrays and objects are nested; stops counting beyond the limit.
std::size_t nesting(std::string_view text) {
  std::size_t depth = 0;
  std::size_t deepest = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size() && deepest <= kMaxDepth; ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
  return deepest;
}

/// Parses strictly: a repeated member is an error, because readers disagree about which one counts.
Result<json> parse_body(std::string_view text) {
  if (nesting(text) > kMaxDepth)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("the request body is nested deeper than {} levels", kMaxDepth));
  std::vector<std::set<std::string>> members;
  std::string repeated;
  const auto note_members = [&](int, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) members.emplace_back();
    if (event == json::parse_event_t::object_end) members.pop_back();
    if (event == json::parse_event_t::key &&
        !members.back().insert(parsed.get<std::string>()).second)
      repeated = parsed.get<std::string>();
    return true;
  };
  try {
    auto body = json::parse(text, note_members);
    if (!repeated.empty())
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("the request body has the member `{}` twice", repeated));
    if (!body.is_object()) return wrong("the request body", body, "a JSON object");
    return body;
  } catch (const json::exception& error) {
    const std::string_view what = error.what();
    const auto prefix = what.find("] ");
    return fail(ErrorCode::InvalidArgument,
                fmt::format("the request body is not valid JSON: {}",
                            prefix == std::string_view::npos ? what : what.substr(prefix + 2)));
  }
}

Result<void> check_members(std::string_view where, const json& object,
                           std::initializer_list<std::string_view> known) {
  for (const auto& [name, value] : object.items())
    if (std::ranges::find(known, name) == known.end())
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("{} has an unknown member `{}`; known: {}", where, name,
                              fmt::join(known, ", ")));
  return {};
}

/// The value behind OGC's forms: plain, bounding box, or {"value": …}.
Result<json> plain_value(const std::string& name, const json& given) {
  if (given.is_array()) {
    json values = json::array();
    for (const auto& item : given) {
      auto value = plain_value(name, item);
      if (!value) return value;
      values.push_back(*std::move(value));
    }
    return values;
  }
  if (!given.is_object() || given.contains("bbox")) return given;
  if (given.contains("href"))
    return fail(ErrorCode::Unimplemented,
                fmt::format("input `{}` is a link; inputs by reference are not supported, expected "
                            "the value itself",
                            name));
  if (!given.contains("value"))
    return wrong(fmt::format("input `{}`", name), given,
                 "a plain value, a bounding box, or an object with the member `value`");
  if (auto known = check_members(fmt::format("input `{}`", name), given,
                                 {"value", "mediaType", "encoding", "schema", "format"});
      !known)
    return known.error();
  return given["value"];
}

Result<std::string> decode_inputs(const json& body) {
  const auto inputs = body.value("inputs", json::object());
  if (!inputs.is_object()) return wrong("`inputs`", inputs, "an object of inputs by name");
  json plain = json::object();
  for (const auto& [name, given] : inputs.items()) {
    auto value = plain_value(name, given);
    if (!value) return value.error();
    plain[name] = *std::move(value);
  }
  return plain.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Every format has one media type; asking for another one is refused instead of ignored.
Result<void> check_format(const ProcessSpec& process, const std::string& id, const json& format) {
  const auto name = fmt::format("output `{}`: `format`", id);
  if (!format.is_object()) return wrong(name, format, "an object");
  if (!format.contains("mediaType")) return {};
  const auto spec = std::ranges::find(process.outputs, id, &OutputSpec::id);
  if (spec != process.outputs.end() && format["mediaType"] != spec->media_type)
    return wrong(fmt::format("output `{}`: `mediaType`", id), format["mediaType"],
                 fmt::format("\"{}\"", spec->media_type));
  return {};
}

Result<std::map<std::string, Transmission>> decode_outputs(const ProcessSpec& process,
                                                           const json& body) {
  const auto outputs = body.value("outputs", json::object());
  if (!outputs.is_object())
    return wrong("`outputs`", outputs, "an object of outputs by name, as in {\"obj\": {}}");
  std::map<std::string, Transmission> wanted;
  for (const auto& [id, output] : outputs.items()) {
    const auto name = fmt::format("output `{}`", id);
    if (!output.is_object()) return wrong(name, output, "an object");
    if (auto known = check_members(name, output, {"transmissionMode", "format"}); !known)
      return known.error();
    if (output.contains("format"))
      if (auto checked = check_format(process, id, output["format"]); !checked)
        return checked.error();
    const auto mode = output.value("transmissionMode", json("value"));
    if (mode != "value" && mode != "reference")
      return wrong(name + ": `transmissionMode`", mode, "\"value\" or \"reference\"");
    wanted[id] = mode == "value" ? Transmission::Value : Transmission::Reference;
  }
  return wanted;
}

Result<Subscriber> decode_subscriber(const json& body) {
  Subscriber wanted;
  if (!body.contains("subscriber")) return wanted;
  const auto& given = body["subscriber"];
  if (!given.is_object() || given.empty())
    return wrong("`subscriber`", given,
                 "an object with `successUri`, `inProgressUri` or `failedUri`");
  if (auto known =
          check_members("`subscriber`", given, {"successUri", "inProgressUri", "failedUri"});
      !known)
    return known.error();
  for (const auto& [name, uri] : {std::pair{"successUri", &wanted.success_uri},
                                  std::pair{"inProgressUri", &wanted.in_progress_uri},
                                  std::pair{"failedUri", &wanted.failed_uri}}) {
    if (!given.contains(name)) continue;
    if (!given[name].is_string() || given[name].get_ref<const std::string&>().empty())
      return wrong(fmt::format("`subscriber`: `{}`", name), given[name], "a URI");
    *uri = given[name].get<std::string>();
  }
  return wanted;
}

/// What `outputs` stands for when it is absent: every default output, of the formats those wanted.
Result<std::map<std::string, Transmission>> all_outputs(const ProcessSpec& process,
                                                        const JobSpec& spec) {
  auto inputs = complete_inputs(process, spec.inputs_json);
  if (!inputs) return inputs.error();
  const auto formats = json::parse(*inputs, nullptr, false).value("formats", json::array());
  std::map<std::string, Transmission> all;
  for (const auto& output : process.outputs) {
    const bool left_out = find_format(output.id) != nullptr &&
                          std::ranges::find(formats, json(output.id)) == formats.end();
    if (is_default_output(process, output) && !left_out)
      all[std::string(output.id)] = Transmission::Value;
  }
  return all;
}

}  // namespace

Result<JobSpec> decode_execute(const ProcessSpec& process, std::string_view text) {
  auto body = parse_body(text);
  if (!body) return body.error();
  if (auto known =
          check_members("the request body", *body, {"inputs", "outputs", "response", "subscriber"});
      !known)
    return known.error();

  JobSpec spec;
  spec.process = process.id;
  auto inputs = decode_inputs(*body);
  if (!inputs) return inputs.error();
  spec.inputs_json = *std::move(inputs);

  auto subscriber = decode_subscriber(*body);
  if (!subscriber) return subscriber.error();
  spec.subscriber = *std::move(subscriber);

  auto outputs = decode_outputs(process, *body);
  if (!outputs) return outputs.error();
  spec.outputs = *std::move(outputs);

  if (!body->contains("response")) return spec;
  const auto& response = (*body)["response"];
  if (response != "raw" && response != "document")
    return wrong("`response`", response, "\"raw\" or \"document\"");
  spec.response_document = response == "document";
  if (spec.outputs.empty()) {
    auto all = all_outputs(process, spec);
    if (!all) return all.error();
    spec.outputs = *std::move(all);
  }
  return spec;
}

}  // namespace citymesh
