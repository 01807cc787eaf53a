#include <simdjson.h>

#include <array>
#include <cerrno>
#include <utility>

#include "core/gates/parse.h"
#include "core/gates/polygons.h"

namespace citymesh {
namespace {

namespace json = simdjson::ondemand;

/// A finding of ours in text that is well-formed JSON.
struct Refused {
  std::string what;
};

std::string text_of(json::value value) { return std::string(std::string_view(value.get_string())); }

/// The vertices of the whole file, as the integers they are, and the step of each axis.
struct Frame {
  std::array<double, 3> scale{};
  std::vector<std::array<std::int64_t, 3>> vertices{};
};

void read_scale(json::document& document, Frame& frame) {
  json::object transform = document["transform"].get_object();
  std::size_t axis = 0;
  for (double value : transform["scale"].get_array()) {
    if (axis == 3 || !(value > 0)) throw Refused{"transform.scale: expected three numbers above 0"};
    frame.scale[axis++] = value;
  }
  if (axis != 3) throw Refused{"transform.scale: expected three numbers above 0"};
}

void read_vertices(json::document& document, Frame& frame) {
  frame.vertices.clear();
  for (json::array vertex : document["vertices"].get_array()) {
    std::array<std::int64_t, 3> xyz{};
    std::size_t axis = 0;
    for (std::int64_t value : vertex) {
      if (axis == 3)
        throw Refused{"vertex " + std::to_string(frame.vertices.size()) +
                      ": more than three numbers"};
      xyz[axis++] = value;
    }
    if (axis != 3)
      throw Refused{"vertex " + std::to_string(frame.vertices.size()) + ": expected three numbers"};
    frame.vertices.push_back(xyz);
  }
}

/// Throws what a result of ours holds against the text.
template <class T>
T taken(Result<T> result) {
  if (!result) throw Refused{result.error().message};
  return std::move(*result);
}
void taken(const Result<void>& result) {
  if (!result) throw Refused{result.error().message};
}

Point3 place(const Frame& frame, std::uint64_t index, const std::string& object) {
  if (index >= frame.vertices.size())
    throw Refused{"object " + in_quotes(object) + ": vertex " + std::to_string(index) + " of " +
                  std::to_string(frame.vertices.size())};
  const auto& v = frame.vertices[static_cast<std::size_t>(index)];
  return {static_cast<double>(v[0]) * frame.scale[0], static_cast<double>(v[1]) * frame.scale[1],
          static_cast<double>(v[2]) * frame.scale[2]};
}

/// The rings of all faces; the semantics that name their patches may stand before or behind them.
struct Faces {
  std::vector<std::vector<std::vector<std::uint32_t>>> rings{};
  std::vector<std::string> types{};
  std::vector<std::int64_t> values{};  ///< -1: null
  bool semantics = false;
};

/// `nesting`: lists between this one and the faces.
void read_boundaries(json::array list, int nesting, const Frame& frame, PolygonBody& body,
                     Faces& faces) {
  for (json::array item : list) {
    if (nesting > 0) {
      read_boundaries(item, nesting - 1, frame, body, faces);
      continue;
    }
    auto& rings = faces.rings.emplace_back();
    for (json::array ring : item) {
      auto& corners = rings.emplace_back();
      for (std::uint64_t index : ring)
        corners.push_back(taken(body.point(place(frame, index, body.name()))));
    }
  }
}

void read_values(json::array list, int nesting, Faces& faces) {
  for (json::value item : list) {
    if (nesting > 0) {
      read_values(item.get_array(), nesting - 1, faces);
    } else {
      faces.values.push_back(item.is_null() ? -1 : static_cast<std::int64_t>(item.get_uint64()));
    }
  }
}

ParsedBody read_solid(json::object geometry, int nesting, const std::string& id,
                      const Frame& frame) {
  PolygonBody body(id);
  Faces faces;
  read_boundaries(geometry["boundaries"].get_array(), nesting, frame, body, faces);
  auto semantics = geometry["semantics"];
  if (semantics.error() != simdjson::NO_SUCH_FIELD) {
    json::object members = semantics.get_object();
    for (json::object surface : members["surfaces"].get_array())
      faces.types.push_back(text_of(surface["type"]));
    read_values(members["values"].get_array(), nesting, faces);
    if (faces.values.size() != faces.rings.size())
      throw Refused{"object " + in_quotes(id) + ": " + std::to_string(faces.values.size()) +
                    " semantic values for " + std::to_string(faces.rings.size()) + " faces"};
  } else {
    faces.values.assign(faces.rings.size(), -1);
  }
  for (std::size_t f = 0; f < faces.rings.size(); ++f) {
    const std::int64_t value = faces.values[f];
    if (value >= static_cast<std::int64_t>(faces.types.size()))
      throw Refused{"object " + in_quotes(id) + ": semantic surface " + std::to_string(value) +
                    " of " + std::to_string(faces.types.size())};
    taken(body.add(faces.rings[f],
                   value < 0 ? std::string_view() : faces.types[static_cast<std::size_t>(value)]));
  }
  return body.take();
}

Result<void> read_objects(json::document& document, const Frame& frame,
                          const ParsedBodySink& sink) {
  for (auto field : document["CityObjects"].get_object()) {
    const std::string id(std::string_view(field.unescaped_key()));
    json::object object = field.value().get_object();
    auto geometries = object["geometry"];
    if (geometries.error() == simdjson::NO_SUCH_FIELD) continue;
    for (json::object geometry : geometries.get_array()) {
      const std::string type = text_of(geometry["type"]);
      if (type != "Solid" && type != "MultiSolid")
        throw Refused{"object " + in_quotes(id) + ": expected a Solid instead of " +
                      in_quotes(type)};
      if (auto done = sink(read_solid(geometry, type == "Solid" ? 1 : 2, id, frame)); !done)
        return done;
    }
  }
  return {};
}

std::string where(json::document& document, const simdjson::padded_string& text) {
  const char* at = nullptr;
  if (document.current_location().get(at) != simdjson::SUCCESS) return "at the end";
  return "byte " + std::to_string(at - text.data());
}

/// Reads one document, the whole file or a line of it.
template <class Read>
Result<void> with_document(json::parser& parser, const simdjson::padded_string& text, Read&& read) {
  json::document document;
  if (const auto error = parser.iterate(text).get(document); error != simdjson::SUCCESS)
    return fail(ErrorCode::DataLoss, simdjson::error_message(error));
  try {
    return read(document);
  } catch (const Refused& refused) {
    return fail(ErrorCode::DataLoss, refused.what);
  } catch (const simdjson::simdjson_error& error) {
    return fail(ErrorCode::DataLoss, where(document, text) + ": " + error.what());
  }
}

Result<void> check_head(json::document& document) {
  if (std::string_view(document["type"].get_string()) != "CityJSON" ||
      std::string_view(document["version"].get_string()) != "2.0")
    return fail(ErrorCode::DataLoss, "expected a CityJSON document of version 2.0");
  return {};
}

Result<void> parse(const simdjson::padded_string& text, const ParsedBodySink& sink) {
  json::parser parser;
  return with_document(parser, text, [&](json::document& document) -> Result<void> {
    if (auto head = check_head(document); !head) return head;
    Frame frame;
    read_scale(document, frame);
    read_vertices(document, frame);
    document.rewind();
    return read_objects(document, frame, sink);
  });
}

/// Takes the lines of a sequence: the first has the transform, the others a feature each.
class Sequence {
 public:
  explicit Sequence(const ParsedBodySink& sink) : sink_(sink) {}

  Result<void> line(std::string_view line, std::uint64_t number) {
    const simdjson::padded_string text(line);
    auto read = with_document(parser_, text, [&](json::document& document) -> Result<void> {
      if (!std::exchange(any_, true)) {
        if (auto head = check_head(document); !head) return head;
        read_scale(document, frame_);
        return {};
      }
      if (std::string_view(document["type"].get_string()) != "CityJSONFeature")
        throw Refused{"expected a CityJSONFeature"};
      const std::string id(std::string_view(document["id"].get_string()));
      read_vertices(document, frame_);
      document.rewind();
      if (document["CityObjects"][id].error() != simdjson::SUCCESS)
        throw Refused{"no object has the id of the feature, " + in_quotes(id)};
      document.rewind();
      return read_objects(document, frame_, sink_);
    });
    if (read || read.error().code != ErrorCode::DataLoss) return read;
    return line_error(number, read.error().message);
  }

  Result<void> end() const {
    if (any_) return {};
    return fail(ErrorCode::DataLoss, "expected a CityJSON document in the first line");
  }

 private:
  const ParsedBodySink& sink_;
  json::parser parser_{};
  Frame frame_{};
  bool any_ = false;
};

}  // namespace

Result<void> parse_cityjson_text(std::string_view text, const ParsedBodySink& sink) {
  return parse(simdjson::padded_string(text), sink);
}

Result<void> parse_cityjson_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  std::error_code error;
  const bool there = std::filesystem::exists(file, error);
  if (error || !there) return file_error(file, error ? error.value() : ENOENT);
  simdjson::padded_string text;
  if (simdjson::padded_string::load(file.string()).get(text) != simdjson::SUCCESS)
    return file_error(file, EIO);
  return parse(text, sink);
}

Result<void> parse_cityjsonseq_text(std::string_view text, const ParsedBodySink& sink) {
  Sequence sequence(sink);
  auto read = for_each_line(text, [&](std::string_view line, std::uint64_t number) {
    return sequence.line(line, number);
  });
  return read ? sequence.end() : read;
}

Result<void> parse_cityjsonseq_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  constexpr std::size_t kLongestBuilding = std::size_t{1} << 30;
  Sequence sequence(sink);
  auto read = for_each_line(
      file,
      [&](std::string_view line, std::uint64_t number) { return sequence.line(line, number); },
      kLongestBuilding);
  return read ? sequence.end() : read;
}

}  // namespace citymesh
