#include <simdjson.h>

#include <array>
#include <optional>

#include "core/source/cityjson.h"
#include "core/source/cityjson_geometry.h"
#include "core/source/cityjson_objects.h"
#include "core/source/input.h"

namespace citymesh::source {
namespace {

namespace dom = simdjson::dom;

bool blank(const std::string& line) {
  return line.find_first_not_of(" \t\r\n") == std::string::npos;
}

bool read_vertices(dom::object feature, const CityJsonHeader& header,
                   std::vector<Point3>& vertices) {
  vertices.clear();
  dom::array list;
  if (feature["vertices"].get(list) != simdjson::SUCCESS) return false;
  for (const dom::element element : list) {
    dom::array triple;
    if (element.get(triple) != simdjson::SUCCESS) return false;
    std::array<double, 3> values{};
    std::size_t i = 0;
    for (const dom::element value : triple)
      if (i == 3 || value.get(values[i++]) != simdjson::SUCCESS) return false;
    if (i != 3) return false;
    vertices.push_back(header.place(values[0], values[1], values[2]));
  }
  return true;
}

}  // namespace

Result<void> read_cityjson_seq(ByteReader& bytes, const DocumentOptions& options,
                               DocumentFacts& facts, const FeatureSink& sink) {
  facts.format = "CityJSONSeq";
  dom::parser parser;
  if (parser.allocate(1u << 16, options.limits.max_depth) != simdjson::SUCCESS)
    return fail(ErrorCode::ResourceExhausted, "no memory for a JSON parser");
  Input lines(bytes, options.limits.max_building_bytes);
  std::string line;
  simdjson::padded_string padded;
  const auto at_line = [&](const std::string& reason) {
    note_failure(facts, "line " + std::to_string(lines.line()) + ": " + reason);
  };

  CityJsonHeader header;
  CityJsonDelivery delivery(options, facts, sink, header);
  std::vector<Point3> vertices;
  bool header_read = false;
  for (;;) {
    if (options.stop.stop_requested()) return fail(ErrorCode::Cancelled, "reading was stopped");
    const std::uint64_t begin = lines.offset();
    const auto more = lines.next_line(line);
    if (!more) {
      note_failure(facts, more.error().message);
      return {};
    }
    if (!*more) break;
    if (!header_read && line.rfind("\xef\xbb\xbf", 0) == 0) line.erase(0, 3);
    if (blank(line)) continue;
    padded = simdjson::padded_string(line);
    dom::object object;
    if (const auto code = parser.parse(padded).get(object); code != simdjson::SUCCESS) {
      at_line(simdjson::error_message(code));
      if (!header_read) return {};
      continue;  // the lines are independent of each other
    }

    if (!header_read) {
      header_read = true;
      std::string wrong = read_type_and_version(text_member(object, "type"),
                                                text_member(object, "version"), true, facts);
      if (wrong.empty()) {
        std::optional<dom::element> transform;
        dom::element element;
        if (object["transform"].get(element) == simdjson::SUCCESS) transform = element;
        wrong = read_transform(transform ? &*transform : nullptr, facts, header);
      }
      if (!wrong.empty()) {
        at_line(wrong);
        return {};
      }
      if (dom::element metadata; object["metadata"].get(metadata) == simdjson::SUCCESS)
        read_metadata(metadata, facts, header);
      if (dom::element templates; object["geometry-templates"].get(templates) == simdjson::SUCCESS)
        read_templates(templates, options, header);
      if (!options.piece) facts.envelopes.push_back({.before = line + "\n"});
      continue;
    }

    if (text_member(object, "type") != "CityJSONFeature") {
      at_line("member 'type' is not 'CityJSONFeature'");
      continue;
    }
    dom::object city_objects;
    if (object["CityObjects"].get(city_objects) != simdjson::SUCCESS) {
      at_line("member 'CityObjects' is missing or no JSON object");
      continue;
    }
    if (!read_vertices(object, header, vertices)) {
      at_line("member 'vertices' is no list of three numbers each");
      continue;
    }
    const ByteRange bytes_of_line = options.piece ? ByteRange{} : ByteRange{begin, lines.offset()};
    CityObjects tree;
    std::vector<std::optional<dom::object>> loaded;
    for (const auto& [key, value] : city_objects) {
      dom::object city_object;
      loaded.emplace_back();
      if (value.get(city_object) == simdjson::SUCCESS)
        loaded.back() = city_object;
      else
        at_line("city object '" + std::string(key) + "' is no JSON object");
      tree.add(std::string(key), loaded.back() ? &*loaded.back() : nullptr);
    }
    tree.link();
    const auto load = [&](std::uint32_t i) { return loaded[i] ? &*loaded[i] : nullptr; };
    if (auto taken = delivery.deliver(tree, vertices, load, bytes_of_line); !taken) return taken;
  }
  if (!header_read) note_failure(facts, "the file is empty, expected a CityJSON object in line 1");
  return {};
}

}  // namespace citymesh::source
