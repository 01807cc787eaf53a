#include <simdjson.h>

#include <array>
#include <cerrno>
#include <unordered_map>

#include "core/gates/parse.h"

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

Frame read_frame(json::document& document) {
  Frame frame;
  json::object transform = document["transform"].get_object();
  std::size_t axis = 0;
  for (double value : transform["scale"].get_array()) {
    if (axis == 3 || !(value > 0)) throw Refused{"transform.scale: expected three numbers above 0"};
    frame.scale[axis++] = value;
  }
  if (axis != 3) throw Refused{"transform.scale: expected three numbers above 0"};
  for (json::array vertex : document["vertices"].get_array()) {
    std::array<std::int64_t, 3> xyz{};
    axis = 0;
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
  return frame;
}

/// Maps indices of the file to those of one body.
class BodyPoints {
 public:
  BodyPoints(const Frame& frame, ParsedBody& body) : frame_(frame), body_(body) {}

  std::uint32_t index_of(std::uint64_t in_file) {
    if (in_file >= frame_.vertices.size())
      throw Refused{"object " + in_quotes(body_.name) + ": vertex " + std::to_string(in_file) +
                    " of " + std::to_string(frame_.vertices.size())};
    const auto [entry, is_new] =
        known_.try_emplace(in_file, static_cast<std::uint32_t>(body_.points.size()));
    if (is_new) {
      const auto& v = frame_.vertices[static_cast<std::size_t>(in_file)];
      body_.points.push_back({static_cast<double>(v[0]) * frame_.scale[0],
                              static_cast<double>(v[1]) * frame_.scale[1],
                              static_cast<double>(v[2]) * frame_.scale[2]});
    }
    return entry->second;
  }

 private:
  const Frame& frame_;
  ParsedBody& body_;
  std::unordered_map<std::uint64_t, std::uint32_t> known_{};
};

void read_boundaries(json::array shells, const Frame& frame, ParsedBody& body) {
  BodyPoints points(frame, body);
  const auto refuse = [&body] {
    return Refused{"object " + in_quotes(body.name) + ": expected triangles without holes"};
  };
  for (json::array shell : shells) {
    for (json::array face : shell) {
      std::size_t rings = 0;
      for (json::array ring : face) {
        if (++rings > 1) throw refuse();
        Triangle triangle{};
        std::size_t corners = 0;
        for (std::uint64_t index : ring) {
          if (corners == 3) throw refuse();
          triangle[corners++] = points.index_of(index);
        }
        if (corners != 3) throw refuse();
        body.triangles.push_back(triangle);
      }
      if (rings != 1) throw refuse();
    }
  }
}

void read_semantics(json::object semantics, ParsedBody& body) {
  std::vector<std::string> types;
  for (json::object surface : semantics["surfaces"].get_array())
    types.push_back(text_of(surface["type"]));
  for (json::value shell : semantics["values"].get_array()) {
    for (json::value value : shell.get_array()) {
      if (value.is_null()) {
        body.patches.emplace_back();
        continue;
      }
      const std::uint64_t index = value.get_uint64();
      if (index >= types.size())
        throw Refused{"object " + in_quotes(body.name) + ": semantic surface " +
                      std::to_string(index) + " of " + std::to_string(types.size())};
      body.patches.push_back(types[static_cast<std::size_t>(index)]);
    }
  }
}

Result<void> read_objects(json::document& document, const Frame& frame,
                          const ParsedBodySink& sink) {
  for (auto field : document["CityObjects"].get_object()) {
    const std::string id(std::string_view(field.unescaped_key()));
    json::object object = field.value().get_object();
    auto geometries = object["geometry"];
    if (geometries.error() == simdjson::NO_SUCH_FIELD) continue;
    for (json::object geometry : geometries.get_array()) {
      ParsedBody body;
      body.name = id;
      if (const std::string type = text_of(geometry["type"]); type != "Solid")
        throw Refused{"object " + in_quotes(id) + ": expected a Solid instead of " +
                      in_quotes(type)};
      read_boundaries(geometry["boundaries"].get_array(), frame, body);
      auto semantics = geometry["semantics"];
      if (semantics.error() == simdjson::NO_SUCH_FIELD) {
        body.patches.resize(body.triangles.size());
      } else {
        read_semantics(semantics.get_object(), body);
      }
      if (body.patches.size() != body.triangles.size())
        throw Refused{"object " + in_quotes(id) + ": " + std::to_string(body.patches.size()) +
                      " semantic values for " + std::to_string(body.triangles.size()) + " faces"};
      if (auto taken = sink(std::move(body)); !taken) return taken;
    }
  }
  return {};
}

std::string where(json::document& document, const simdjson::padded_string& text) {
  const char* at = nullptr;
  if (document.current_location().get(at) != simdjson::SUCCESS) return "at the end";
  return "byte " + std::to_string(at - text.data());
}

Result<void> parse(const simdjson::padded_string& text, const ParsedBodySink& sink) {
  json::parser parser;
  json::document document;
  if (const auto error = parser.iterate(text).get(document); error != simdjson::SUCCESS)
    return fail(ErrorCode::DataLoss, simdjson::error_message(error));
  try {
    if (std::string_view(document["type"].get_string()) != "CityJSON" ||
        std::string_view(document["version"].get_string()) != "2.0")
      return fail(ErrorCode::DataLoss, "expected a CityJSON document of version 2.0");
    const Frame frame = read_frame(document);
    document.rewind();
    return read_objects(document, frame, sink);
  } catch (const Refused& refused) {
    return fail(ErrorCode::DataLoss, refused.what);
  } catch (const simdjson::simdjson_error& error) {
    return fail(ErrorCode::DataLoss, where(document, text) + ": " + error.what());
  }
}

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

}  // namespace citymesh
