#include "core/source/cityjson.h"

#include <simdjson.h>

#include <limits>
#include <optional>
#include <utility>

#include "core/source/cityjson_geometry.h"
#include "core/source/cityjson_objects.h"
#include "core/source/json_text.h"

namespace citymesh::source {
namespace {

namespace dom = simdjson::dom;

// The name between quotes, escapes resolved.
std::string unescaped(const std::string& raw, dom::parser& parser) {
  if (raw.find('\\') == std::string::npos) return raw;
  std::string_view text;
  if (parser.parse(simdjson::padded_string('"' + raw + '"')).get(text) != simdjson::SUCCESS)
    return raw;
  return std::string(text);
}

}  // namespace

Result<void> read_cityjson(const RandomReader& file, const DocumentOptions& options,
                           DocumentFacts& facts, const FeatureSink& sink) {
  facts.format = "CityJSON";
  const unsigned depth = options.limits.max_depth;
  const JsonText json(file, depth);
  dom::parser parser;
  if (parser.allocate(1u << 16, depth) != simdjson::SUCCESS)
    return fail(ErrorCode::ResourceExhausted, "no memory for a JSON parser");

  std::vector<JsonMember> members;
  if (auto split = json.members(json.all(), members); !split) {
    note_failure(facts, split.error().message);
    return {};
  }
  const auto slice_of = [&](std::string_view key) -> const JsonSlice* {
    for (const JsonMember& member : members)
      if (member.raw_key == key) return &member.value;
    return nullptr;
  };
  // Parses a slice; the element lives until the next call.
  simdjson::padded_string padded;
  const auto parse = [&](const JsonSlice& slice, const std::string& what) {
    std::optional<dom::element> parsed;
    auto text = json.text(slice, options.limits.max_building_bytes);
    if (!text) {
      note_failure(facts, text.error().message);
      return parsed;
    }
    padded = simdjson::padded_string(*text);
    dom::element element;
    if (const auto code = parser.parse(padded).get(element); code != simdjson::SUCCESS)
      note_failure(facts, "line " + std::to_string(slice.line) + ": " + what + ": " +
                              simdjson::error_message(code));
    else
      parsed = element;
    return parsed;
  };
  const auto text_of = [&](std::string_view key) {
    std::optional<std::string> text;
    const JsonSlice* slice = slice_of(key);
    if (!slice) return text;
    const auto element = parse(*slice, "member '" + std::string(key) + "'");
    std::string_view view;
    if (element && element->get(view) == simdjson::SUCCESS) text = view;
    return text;
  };

  CityJsonHeader header;
  const auto type = text_of("type");
  const auto version = text_of("version");
  std::string wrong = read_type_and_version(type, version, false, facts);
  if (wrong.empty()) {
    std::optional<dom::element> transform;
    if (const JsonSlice* slice = slice_of("transform")) transform = parse(*slice, "'transform'");
    wrong = read_transform(transform ? &*transform : nullptr, facts, header);
  }
  if (!wrong.empty()) {
    note_failure(facts, std::move(wrong));
    return {};
  }
  if (const JsonSlice* slice = slice_of("metadata"))
    if (const auto metadata = parse(*slice, "'metadata'")) read_metadata(*metadata, facts, header);

  if (const JsonSlice* slice = slice_of("geometry-templates"))
    if (const auto templates = parse(*slice, "'geometry-templates'"))
      read_templates(*templates, options, header);

  const JsonSlice* vertices_slice = slice_of("vertices");
  const JsonSlice* objects_slice = slice_of("CityObjects");
  if (!vertices_slice || !objects_slice) {
    note_failure(facts, std::string("member '") + (vertices_slice ? "CityObjects" : "vertices") +
                            "' is missing");
    return {};
  }
  std::vector<Point3> vertices;
  constexpr std::uint64_t kMaxVertices = std::numeric_limits<std::uint32_t>::max();
  if (auto read = json.triples(*vertices_slice, kMaxVertices, vertices); !read) {
    note_failure(facts, "member 'vertices': " + read.error().message);
    return {};
  }
  for (Point3& vertex : vertices) vertex = header.place(vertex.x, vertex.y, vertex.z);

  std::vector<JsonMember> objects;
  if (auto split = json.members(*objects_slice, objects); !split)
    note_failure(facts, "member 'CityObjects': " + split.error().message);
  dom::object found;
  const auto load = [&](std::uint32_t i) -> const dom::object* {
    const auto element = parse(objects[i].value, "city object '" + objects[i].raw_key + "'");
    if (element && element->get(found) == simdjson::SUCCESS) return &found;
    if (element)
      note_failure(facts, "line " + std::to_string(objects[i].value.line) + ": city object '" +
                              objects[i].raw_key + "' is no JSON object");
    return nullptr;
  };
  CityObjects tree;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    if (options.stop.stop_requested()) return fail(ErrorCode::Cancelled, "reading was stopped");
    std::string id = unescaped(objects[i].raw_key, parser);
    tree.add(std::move(id), load(i));
  }
  tree.link();
  return CityJsonDelivery(options, facts, sink, header).deliver(tree, vertices, load);
}

}  // namespace citymesh::source
