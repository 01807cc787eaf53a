#include "core/write/glb_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/write/bytes.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

constexpr std::uint64_t kMaxBytes = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kHeadBytes = 8192;  // more than is not in the sections
constexpr std::int64_t kStepsPerMetre = static_cast<std::int64_t>(kGridStepsPerMetre);
// Up to here the nearest float32 is nearer to its grid point than to any other.
constexpr std::int64_t kFloat32Reach = 1024 * kStepsPerMetre;

/// The whole metre below a value in grid steps.
std::int64_t floored_metre(std::int64_t steps) {
  return steps >= 0 ? steps / kStepsPerMetre : -((kStepsPerMetre - 1 - steps) / kStepsPerMetre);
}

/// East, north, up becomes x, z south, y up.
GridPoint y_up(const GridPoint& p) { return {p.x, p.z, -p.y}; }

void append_three(std::string& json, const std::array<float, 3>& values) {
  for (std::size_t i = 0; i < 3; ++i) {
    json += i == 0 ? '[' : ',';
    append_exact(json, static_cast<double>(values[i]));
  }
  json += ']';
}

double linear(std::uint8_t srgb) {  // IEC 61966-2-1
  const double c = srgb / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Error too_wide(std::string_view name, std::int64_t reach) {
  std::string message = "glb: body ";
  append_json_string(message, name);
  message += " reaches ";
  append_grid(message, reach);
  message +=
      " m from its middle; float32 holds the 0.1 mm grid only up to 1024 m: use format ply or obj";
  return fail(ErrorCode::FailedPrecondition, std::move(message));
}

Error too_large() {
  return fail(ErrorCode::FailedPrecondition,
              "glb: the file would be larger than 4 GiB, which GLB cannot be: take a smaller "
              "box, or format ply or obj");
}

}  // namespace

/// Points as their node counts them.
struct GlbParts::LocalPoints {
  explicit LocalPoints(std::span<const GridPoint> all);

  GridPoint centre_m{};  ///< whole metres, axes of glTF: exact also where a viewer has float32 only
  std::vector<std::array<float, 3>> points{};
  std::array<float, 3> min{}, max{};
  std::int64_t reach = 0;
};

GlbParts::LocalPoints::LocalPoints(std::span<const GridPoint> all) {
  if (all.empty()) return;
  GridPoint low = y_up(all[0]), high = low;
  for (const GridPoint& point : all) {
    const GridPoint p = y_up(point);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  centre_m = {floored_metre((low.x + high.x) / 2), floored_metre((low.y + high.y) / 2),
              floored_metre((low.z + high.z) / 2)};
  min.fill(std::numeric_limits<float>::max());
  max.fill(std::numeric_limits<float>::lowest());
  for (const GridPoint& point : all) {
    const GridPoint p = y_up(point);
    const GridPoint q{p.x - centre_m.x * kStepsPerMetre, p.y - centre_m.y * kStepsPerMetre,
                      p.z - centre_m.z * kStepsPerMetre};
    reach = std::max({reach, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    const Point3 m = to_metres(q);
    const auto& xyz = points.emplace_back(
        std::array{static_cast<float>(m.x), static_cast<float>(m.y), static_cast<float>(m.z)});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      min[axis] = std::min(min[axis], xyz[axis]);
      max[axis] = std::max(max[axis], xyz[axis]);
    }
  }
}

Result<void> GlbParts::append(const GlbNode& node, std::array<std::string, kSections>& to) {
  auto& [nodes, meshes, accessors, positions, indices] = to;
  const std::size_t json_before = nodes.size() + meshes.size() + accessors.size();
  const LocalPoints local(node.points);
  if (local.reach > kFloat32Reach) return too_wide(node.name, local.reach);
  append_node(nodes, node, local);
  append_positions(accessors, positions, local);
  append_mesh(meshes, accessors, indices, node);
  position_bytes_ += 12 * local.points.size();
  for (const auto& triangles : node.triangles) index_bytes_ += 12 * triangles.size();
  ++nodes_;
  json_bytes_ += nodes.size() + meshes.size() + accessors.size() - json_before;
  if (kHeadBytes + bytes() > kMaxBytes) return too_large();
  return {};
}

Result<void> GlbParts::join(const std::array<std::uint64_t, kSections>& sizes,
                            SectionSink& sink) const {
  const std::uint64_t binary_bytes = sizes[3] + sizes[4];
  const std::string before_nodes = head();
  const std::string_view before_meshes = "],\"meshes\":[", before_accessors = "],\"accessors\":[";
  const std::string tail = json_tail(sizes[3], sizes[4]);
  std::uint64_t json_bytes = before_nodes.size() + tail.size();
  if (nodes_ > 0)
    json_bytes += sizes[0] + before_meshes.size() + sizes[1] + before_accessors.size() + sizes[2];
  const std::string padding((4 - json_bytes % 4) % 4, ' ');
  json_bytes += padding.size();
  const std::uint64_t total =
      12 + 8 + json_bytes + (binary_bytes > 0 ? 8 + binary_bytes : std::uint64_t{0});
  if (total > kMaxBytes) return too_large();

  std::string start = "glTF";
  append_bytes(start, std::uint32_t{2});
  append_bytes(start, static_cast<std::uint32_t>(total));
  append_bytes(start, static_cast<std::uint32_t>(json_bytes));
  start += "JSON" + before_nodes;
  if (auto r = sink.text(start); !r) return r;
  if (nodes_ > 0) {
    if (auto r = sink.section(0); !r) return r;
    if (auto r = sink.text(before_meshes); !r) return r;
    if (auto r = sink.section(1); !r) return r;
    if (auto r = sink.text(before_accessors); !r) return r;
    if (auto r = sink.section(2); !r) return r;
  }
  if (auto r = sink.text(tail + padding); !r) return r;
  if (binary_bytes == 0) return {};
  std::string chunk;
  append_bytes(chunk, static_cast<std::uint32_t>(binary_bytes));
  chunk.append("BIN\0", 4);
  if (auto r = sink.text(chunk); !r) return r;
  if (auto r = sink.section(3); !r) return r;
  return sink.section(4);
}

void GlbParts::append_node(std::string& json, const GlbNode& node, const LocalPoints& local) const {
  json += nodes_ == 0 ? "\n{\"name\":" : ",\n{\"name\":";
  append_json_string(json, node.name);
  json += ",\"mesh\":" + std::to_string(nodes_) + ",\"translation\":[";
  append_integer(json, local.centre_m.x);
  json += ',';
  append_integer(json, local.centre_m.y);
  json += ',';
  append_integer(json, local.centre_m.z);
  json += "],\"extras\":";
  json += node.extras;
  json += '}';
}

void GlbParts::append_accessor(std::string& json, int view, std::uint64_t offset, int component,
                               std::uint64_t count, std::string_view type) {
  if (accessors_++ > 0) json += ',';
  json += "\n{\"bufferView\":" + std::to_string(view) +
          ",\"byteOffset\":" + std::to_string(offset) +
          ",\"componentType\":" + std::to_string(component) +
          ",\"count\":" + std::to_string(count) + ",\"type\":\"";
  json += type;
  json += '"';
}

void GlbParts::append_positions(std::string& accessors, std::string& bytes,
                                const LocalPoints& local) {
  constexpr int kFloat = 5126;
  append_accessor(accessors, 0, position_bytes_, kFloat, local.points.size(), "VEC3");
  accessors += ",\"min\":";
  append_three(accessors, local.min);
  accessors += ",\"max\":";
  append_three(accessors, local.max);
  accessors += '}';
  for (const auto& xyz : local.points)
    for (const float value : xyz) append_bytes(bytes, value);
}

void GlbParts::append_mesh(std::string& meshes, std::string& accessors, std::string& bytes,
                           const GlbNode& node) {
  constexpr int kUnsignedInt = 5125;
  const std::uint64_t positions = accessors_ - 1;
  meshes += nodes_ == 0 ? "\n{\"primitives\":[" : ",\n{\"primitives\":[";
  std::uint64_t offset = index_bytes_;
  bool leading = true;
  for (std::size_t material = 0; material < node.triangles.size(); ++material) {
    const std::vector<Triangle>& triangles = node.triangles[material];
    if (triangles.empty()) continue;
    if (!std::exchange(leading, false)) meshes += ',';
    meshes += "{\"attributes\":{\"POSITION\":" + std::to_string(positions) +
              "},\"indices\":" + std::to_string(accessors_) +
              ",\"material\":" + std::to_string(material) + "}";
    append_accessor(accessors, 1, offset, kUnsignedInt, 3 * triangles.size(), "SCALAR");
    accessors += '}';
    for (const Triangle& triangle : triangles)
      for (const std::uint32_t corner : triangle) append_bytes(bytes, corner);
    offset += 12 * triangles.size();
  }
  meshes += "]}";
}

std::string GlbParts::head() const {
  std::string json = "{\"asset\":{\"version\":\"2.0\",\"generator\":";
  append_json_string(json, generator());
  json += ",\"extras\":{\"about\":";
  append_json_string(json, scene_text(scene_));
  json += ",\"crs\":";
  append_json_string(json, crs_text(scene_));
  json += ",\"origin\":[";
  append_exact(json, scene_.origin.x);
  json += ',';
  append_exact(json, scene_.origin.y);
  json += ',';
  append_exact(json, scene_.origin.z);
  json += "],\"unit\":\"metre\",\"axes\":\"x east, y up, z south\"}},\n\"materials\":[";
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    json += i == 0 ? "\n{\"name\":\"" : ",\n{\"name\":\"";
    json += materials_[i].name;
    json += "\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[";
    for (const std::uint8_t channel : materials_[i].colour) {
      append_number(json, linear(channel), 5);
      json += ',';
    }
    json += "1],\"metallicFactor\":0,\"roughnessFactor\":0.9}";
    json += materials_[i].double_sided ? ",\"doubleSided\":true}" : "}";
  }
  json += "],\n\"scene\":0";
  return nodes_ == 0 ? json : json + ",\n\"nodes\":[";
}

std::string GlbParts::json_tail(std::uint64_t position_bytes, std::uint64_t index_bytes) const {
  std::string json;
  if (nodes_ > 0) {
    json += "],\n\"bufferViews\":[{\"buffer\":0,\"byteLength\":" + std::to_string(position_bytes) +
            ",\"byteStride\":12,\"target\":34962},{\"buffer\":0,\"byteOffset\":" +
            std::to_string(position_bytes) + ",\"byteLength\":" + std::to_string(index_bytes) +
            ",\"target\":34963}],\n\"buffers\":[{\"byteLength\":" +
            std::to_string(position_bytes + index_bytes) + "}]";
  }
  json += ",\n\"scenes\":[{\"name\":\"citymesh\"";
  for (std::uint64_t i = 0; i < nodes_; ++i)
    json += (i == 0 ? ",\"nodes\":[" : ",") + std::to_string(i);
  if (nodes_ > 0) json += ']';
  return json + "}]}";
}

}  // namespace citymesh
