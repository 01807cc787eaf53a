#include <simdjson.h>

#include <algorithm>
#include <array>

#include "core/gates/byte_source.h"
#include "core/gates/parse.h"

namespace citymesh {
namespace {

namespace json = simdjson::ondemand;

constexpr std::uint64_t kFloat = 5126, kUnsignedInt = 5125;

/// A finding of ours in text that is well-formed JSON.
struct Refused {
  std::string what;
};

struct View {
  std::uint64_t offset = 0, length = 0;
};

struct Accessor {
  std::uint64_t view = 0, offset = 0, component = 0, count = 0;
  bool vectors = false;
  std::array<double, 3> min{}, max{};
};

struct Primitive {
  std::uint64_t positions = 0, indices = 0, material = 0;
};

struct Gltf {
  std::vector<std::string> materials{};
  std::vector<View> views{};
  std::vector<Accessor> accessors{};
  std::vector<std::vector<Primitive>> meshes{};
  std::uint64_t binary_at = 0;
};

std::array<double, 3> three(json::value list) {
  std::array<double, 3> values{};
  std::size_t count = 0;
  for (double value : list.get_array()) {
    if (count == 3) throw Refused{"more than three numbers"};
    values[count++] = value;
  }
  if (count != 3) throw Refused{"fewer than three numbers"};
  return values;
}

std::uint64_t number_or(json::object object, std::string_view key, std::uint64_t otherwise) {
  auto value = object.find_field_unordered(key);
  return value.error() == simdjson::NO_SUCH_FIELD ? otherwise : value.get_uint64();
}

/// The elements of a top-level list; none when the file has no such list.
template <class Take>
void for_each_of(json::document& document, std::string_view key, Take&& take) {
  document.rewind();
  auto list = document[key];
  if (list.error() == simdjson::NO_SUCH_FIELD) return;
  for (json::object element : list.get_array()) take(element);
}

void read_views(json::document& document, std::uint64_t binary_bytes, Gltf& gltf) {
  std::uint64_t buffers = 0;
  for_each_of(document, "buffers", [&](json::object buffer) {
    if (++buffers > 1 || std::uint64_t(buffer["byteLength"]) != binary_bytes)
      throw Refused{"expected one buffer as long as the binary chunk"};
  });
  for_each_of(document, "bufferViews", [&](json::object object) {
    View view{number_or(object, "byteOffset", 0), object["byteLength"].get_uint64()};
    if (view.offset % 4 != 0 || view.offset > binary_bytes ||
        view.length > binary_bytes - view.offset)
      throw Refused{"buffer view " + std::to_string(gltf.views.size()) +
                    " is not aligned or not inside of the buffer"};
    gltf.views.push_back(view);
  });
}

void read_accessors(json::document& document, Gltf& gltf) {
  for_each_of(document, "accessors", [&](json::object object) {
    Accessor accessor{object["bufferView"].get_uint64(), number_or(object, "byteOffset", 0),
                      object["componentType"].get_uint64(), object["count"].get_uint64()};
    accessor.vectors = std::string_view(object["type"].get_string()) == "VEC3";
    if (accessor.vectors) {
      accessor.min = three(object["min"]);
      accessor.max = three(object["max"]);
    }
    const std::uint64_t width = accessor.vectors ? 12 : 4;
    if (accessor.component != (accessor.vectors ? kFloat : kUnsignedInt) || accessor.count == 0 ||
        accessor.view >= gltf.views.size() || accessor.offset % 4 != 0 ||
        accessor.offset > gltf.views[accessor.view].length ||
        accessor.count > (gltf.views[accessor.view].length - accessor.offset) / width)
      throw Refused{"accessor " + std::to_string(gltf.accessors.size()) +
                    " is not as a body's points or corners are"};
    gltf.accessors.push_back(accessor);
  });
}

void read_meshes(json::document& document, Gltf& gltf) {
  for_each_of(document, "materials", [&](json::object material) {
    gltf.materials.emplace_back(std::string_view(material["name"].get_string()));
  });
  for_each_of(document, "meshes", [&](json::object mesh) {
    auto& primitives = gltf.meshes.emplace_back();
    for (json::object object : mesh["primitives"].get_array()) {
      Primitive primitive{object["attributes"]["POSITION"].get_uint64(),
                          object["indices"].get_uint64(), object["material"].get_uint64()};
      if (primitive.positions >= gltf.accessors.size() ||
          primitive.indices >= gltf.accessors.size() ||
          !gltf.accessors[primitive.positions].vectors ||
          gltf.accessors[primitive.indices].vectors || primitive.material >= gltf.materials.size())
        throw Refused{"mesh " + std::to_string(gltf.meshes.size() - 1) +
                      " refers to what is not there"};
      primitives.push_back(primitive);
    }
    for (const Primitive& primitive : primitives)
      if (primitive.positions != primitives[0].positions)
        throw Refused{"mesh " + std::to_string(gltf.meshes.size() - 1) +
                      " has points of several accessors"};
  });
}

class BodyReader {
 public:
  BodyReader(const ByteSource& source, const Gltf& gltf) : source_(source), gltf_(gltf) {}

  ParsedBody read(json::object node) {
    ParsedBody body;
    body.name = std::string_view(node["name"].get_string());
    const std::uint64_t mesh = node["mesh"].get_uint64();
    if (mesh >= gltf_.meshes.size() || gltf_.meshes[mesh].empty())
      throw Refused{"node " + in_quotes(body.name) + " has no mesh"};
    const auto translation = three(node["translation"]);
    // From y up to z up.
    body.centre = {translation[0], -translation[2], translation[1]};
    body.float32 = true;
    read_points(gltf_.accessors[gltf_.meshes[mesh][0].positions], body);
    for (const Primitive& primitive : gltf_.meshes[mesh])
      read_triangles(gltf_.accessors[primitive.indices], gltf_.materials[primitive.material], body);
    return body;
  }

 private:
  void fetch(const Accessor& accessor, std::uint64_t width) {
    const View& view = gltf_.views[accessor.view];
    auto got = source_.read(gltf_.binary_at + view.offset + accessor.offset, accessor.count * width,
                            "accessor", bytes_);
    if (!got) throw Refused{got.error().message};
  }

  void read_points(const Accessor& accessor, ParsedBody& body) {
    fetch(accessor, 12);
    std::array<double, 3> min{}, max{};
    for (std::size_t i = 0; i < accessor.count; ++i) {
      std::array<double, 3> p{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        p[axis] = static_cast<double>(number_at<float>(bytes_, 12 * i + 4 * axis));
        min[axis] = i == 0 ? p[axis] : std::min(min[axis], p[axis]);
        max[axis] = i == 0 ? p[axis] : std::max(max[axis], p[axis]);
      }
      body.points.push_back({body.centre.x + p[0], body.centre.y - p[2], body.centre.z + p[1]});
    }
    if (min != accessor.min || max != accessor.max)
      throw Refused{"node " + in_quotes(body.name) + ": min and max are not those of the points"};
  }

  void read_triangles(const Accessor& accessor, const std::string& patch, ParsedBody& body) {
    if (accessor.count % 3 != 0)
      throw Refused{"node " + in_quotes(body.name) + " has corners that are no triangles"};
    fetch(accessor, 4);
    for (std::size_t i = 0; i < accessor.count; i += 3) {
      Triangle& triangle = body.triangles.emplace_back();
      for (std::size_t corner = 0; corner < 3; ++corner) {
        triangle[corner] = number_at<std::uint32_t>(bytes_, 4 * (i + corner));
        if (triangle[corner] >= body.points.size())
          throw Refused{"node " + in_quotes(body.name) + " uses point " +
                        std::to_string(triangle[corner]) + " of " +
                        std::to_string(body.points.size())};
      }
      body.patches.push_back(patch);
    }
  }

  const ByteSource& source_;
  const Gltf& gltf_;
  std::string bytes_{};
};

Result<void> read_document(const ByteSource& source, json::document& document, Gltf& gltf,
                           std::uint64_t binary_bytes, const ParsedBodySink& sink) {
  if (std::string_view(document["asset"]["version"].get_string()) != "2.0")
    throw Refused{"expected glTF 2.0"};
  read_views(document, binary_bytes, gltf);
  read_accessors(document, gltf);
  read_meshes(document, gltf);

  std::uint64_t nodes = 0, in_scene = 0;
  for_each_of(document, "scenes", [&](json::object scene) {
    auto list = scene["nodes"];
    if (list.error() == simdjson::NO_SUCH_FIELD) return;
    for (std::uint64_t node : list.get_array())
      if (node != in_scene++) throw Refused{"the scene has not every node once"};
  });
  BodyReader reader(source, gltf);
  Result<void> result;
  for_each_of(document, "nodes", [&](json::object node) {
    ++nodes;
    if (result) result = sink(reader.read(node));
  });
  if (result && (nodes != in_scene || nodes != gltf.meshes.size()))
    throw Refused{std::to_string(nodes) + " nodes, " + std::to_string(gltf.meshes.size()) +
                  " meshes and " + std::to_string(in_scene) + " in the scene"};
  return result;
}

Result<void> parse(const ByteSource& source, const ParsedBodySink& sink) {
  const auto refuse = [](const std::string& what) { return fail(ErrorCode::DataLoss, what); };
  std::string bytes;
  if (auto r = source.read(0, 20, "header", bytes); !r) return r;
  const std::uint64_t json_bytes = number_at<std::uint32_t>(bytes, 12);
  if (!bytes.starts_with("glTF") || number_at<std::uint32_t>(bytes, 4) != 2 ||
      number_at<std::uint32_t>(bytes, 8) != source.size() || bytes.substr(16, 4) != "JSON" ||
      json_bytes % 4 != 0)
    return refuse("expected a GLB header of version 2 with the size of the file");
  std::string text;
  if (auto r = source.read(20, json_bytes, "JSON chunk", text); !r) return r;

  Gltf gltf;
  std::uint64_t binary_bytes = 0;
  if (const std::uint64_t end = 20 + json_bytes; end < source.size()) {
    if (auto r = source.read(end, 8, "binary chunk", bytes); !r) return r;
    binary_bytes = number_at<std::uint32_t>(bytes, 0);
    gltf.binary_at = end + 8;
    if (bytes.substr(4) != std::string_view("BIN\0", 4) || binary_bytes % 4 != 0 ||
        gltf.binary_at + binary_bytes != source.size())
      return refuse("expected one binary chunk up to the end of the file");
  }

  const simdjson::padded_string padded(text);
  text = {};
  json::parser parser;
  json::document document;
  if (const auto error = parser.iterate(padded).get(document); error != simdjson::SUCCESS)
    return refuse(simdjson::error_message(error));
  try {
    return read_document(source, document, gltf, binary_bytes, sink);
  } catch (const Refused& refused) {
    return refuse(refused.what);
  } catch (const simdjson::simdjson_error& error) {
    return refuse(std::string("JSON chunk: ") + error.what());
  }
}

}  // namespace

Result<void> parse_glb_text(std::string_view text, const ParsedBodySink& sink) {
  return parse(ByteSource(text), sink);
}

Result<void> parse_glb_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  const auto source = ByteSource::open(file);
  return source ? parse(*source, sink) : source.error();
}

}  // namespace citymesh
