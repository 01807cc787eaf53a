#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <unordered_map>

#include "core/geometry/triangulation.h"
#include "core/write/findings.h"
#include "core/write/painter.h"
#include "core/write/picture.h"
#include "core/write/shell_faces.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

constexpr double kSamePlane_cos = 0.9994;  // 2 degrees

bool is_opening(SurfaceType type) {
  return type == SurfaceType::Window || type == SurfaceType::Door;
}

std::uint64_t edge_key(std::uint32_t from, std::uint32_t to) {
  return (static_cast<std::uint64_t>(from) << 32) | to;
}

/// Triangles with the number of the patch each belongs to.
struct PatchMap {
  std::vector<std::uint32_t> patch_of{};
  std::vector<std::uint32_t> seeds{};  ///< a triangle of each patch
};

using Edges = std::unordered_map<std::uint64_t, std::uint32_t>;  // directed edge → triangle

PatchMap grow_patches(const TriangleMesh& mesh, const std::vector<Point3>& normals,
                      const Edges& edges) {
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  PatchMap patches;
  patches.patch_of.assign(mesh.triangles.size(), kNone);
  std::vector<std::uint32_t> open;
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (patches.patch_of[seed] != kNone) continue;
    const auto patch = static_cast<std::uint32_t>(patches.seeds.size());
    patches.seeds.push_back(seed);
    patches.patch_of[seed] = patch;
    open.assign(1, seed);
    while (!open.empty()) {
      const Triangle& t = mesh.triangles[open.back()];
      open.pop_back();
      for (std::size_t i = 0; i < 3; ++i) {
        const auto neighbour = edges.find(edge_key(t[(i + 1) % 3], t[i]));
        if (neighbour == edges.end()) continue;
        const std::uint32_t n = neighbour->second;
        if (patches.patch_of[n] != kNone || dot(normals[n], normals[seed]) < kSamePlane_cos ||
            is_opening(mesh.surface_types[n]) != is_opening(mesh.surface_types[seed]))
          continue;
        patches.patch_of[n] = patch;
        open.push_back(n);
      }
    }
  }
  return patches;
}

/// Chains the directed border edges of a patch to rings.
std::vector<std::vector<DrawnFace::Corner>> chain_rings(
    const TriangleMesh& mesh, std::vector<std::array<std::uint32_t, 2>> border) {
  std::sort(border.begin(), border.end());
  std::vector<char> used(border.size(), 0);
  std::vector<std::vector<DrawnFace::Corner>> rings;
  for (std::size_t start = 0; start < border.size(); ++start) {
    if (used[start] != 0) continue;
    auto& ring = rings.emplace_back();
    for (std::size_t at = start; used[at] == 0;) {
      used[at] = 1;
      ring.push_back(corner_of(mesh.points[border[at][0]]));
      const std::uint32_t to = border[at][1];
      auto next = std::lower_bound(border.begin(), border.end(), std::array{to, 0u});
      while (next != border.end() && (*next)[0] == to &&
             used[static_cast<std::size_t>(next - border.begin())] != 0)
        ++next;
      if (next == border.end() || (*next)[0] != to) break;
      at = static_cast<std::size_t>(next - border.begin());
    }
  }
  return rings;
}

std::int32_t lowest(const std::vector<GridPoint>& points) {
  return static_cast<std::int32_t>(
      std::min_element(points.begin(), points.end(), [](const GridPoint& a, const GridPoint& b) {
        return a.z < b.z;
      })->z);
}

/// What of a boundary can be triangulated.
std::vector<Triangle> triangles_of(const Shell& shell) {
  std::vector<Triangle> all;
  for (const Face& face : shell.faces)
    if (const auto triangles = triangulate(shell.points, face.rings))
      all.insert(all.end(), triangles->begin(), triangles->end());
  return all;
}

bool is_seen(const Point3& normal) {
  return towards_viewer(to_view(normal)) > 1e-6 || dot(normal, kSun) > 1e-6;
}

}  // namespace

std::vector<DrawnFace> drawn_faces(const TriangleMesh& mesh) {
  std::vector<Point3> normals;
  normals.reserve(mesh.triangles.size());
  Edges edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    normals.push_back(unit_normal(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]));
    for (std::size_t e = 0; e < 3; ++e) edges.try_emplace(edge_key(t[e], t[(e + 1) % 3]), i);
  }
  const PatchMap patches = grow_patches(mesh, normals, edges);

  std::vector<DrawnFace> faces(patches.seeds.size());
  std::vector<std::vector<std::array<std::uint32_t, 2>>> borders(faces.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t patch = patches.patch_of[i];
    if (!is_seen(normals[patches.seeds[patch]])) continue;
    const Triangle& t = mesh.triangles[i];
    faces[patch].triangles.push_back(
        {corner_of(mesh.points[t[0]]), corner_of(mesh.points[t[1]]), corner_of(mesh.points[t[2]])});
    for (std::size_t e = 0; e < 3; ++e) {
      const auto twin = edges.find(edge_key(t[(e + 1) % 3], t[e]));
      if (twin == edges.end() || patches.patch_of[twin->second] != patch)
        borders[patch].push_back({t[e], t[(e + 1) % 3]});
    }
  }
  for (std::size_t p = 0; p < faces.size(); ++p) {
    if (faces[p].triangles.empty()) continue;
    const std::uint32_t seed = patches.seeds[p];
    faces[p].normal = normals[seed];
    faces[p].kind = is_opening(mesh.surface_types[seed]) ? DrawnFace::Kind::Opening
                    : faces[p].normal.z > kRoofNormal_z  ? DrawnFace::Kind::Roof
                                                         : DrawnFace::Kind::Wall;
    faces[p].rings = chain_rings(mesh, std::move(borders[p]));
  }
  std::erase_if(faces, [](const DrawnFace& face) { return face.triangles.empty(); });
  return faces;
}

std::vector<DrawnFace> drawn_faces(const DrawnBlock& block) {
  std::vector<DrawnFace> faces;
  const std::size_t n = block.outline.size();
  const auto at = [&block, n](std::size_t i, std::int32_t z) {
    return DrawnFace::Corner{block.outline[i % n][0], block.outline[i % n][1], z};
  };
  const auto add = [&](std::vector<DrawnFace::Corner> ring, const Point3& normal,
                       DrawnFace::Kind kind) {
    if (!is_seen(normal)) return;
    DrawnFace& face = faces.emplace_back();
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      face.triangles.push_back({ring[0], ring[i], ring[i + 1]});
    face.rings.push_back(std::move(ring));
    face.normal = normal;
    face.kind = kind;
    face.style = block.style;
    face.base = block.base;
  };
  std::vector<DrawnFace::Corner> roof;
  for (std::size_t i = 0; i < n; ++i) {
    const auto a = at(i, block.base), b = at(i + 1, block.base);
    const double dx = static_cast<double>(b[0]) - a[0], dy = static_cast<double>(b[1]) - a[1];
    const double length = std::sqrt(dx * dx + dy * dy);
    if (length > 0)
      add({a, b, at(i + 1, block.top), at(i, block.top)}, {dy / length, -dx / length, 0},
          DrawnFace::Kind::Wall);
    roof.push_back(at(i, block.top));
  }
  add(std::move(roof), {0, 0, 1}, DrawnFace::Kind::Roof);
  return faces;
}

void Picture::add_faces(std::vector<DrawnFace> faces, std::int32_t base) {
  for (DrawnFace& face : faces) {
    face.base = base;
    triangles_ += face.triangles.size();
    faces_.push_back(std::move(face));
  }
  if (triangles_ <= kMaxTriangles) return;
  as_blocks_ = true;
  faces_.clear();
  faces_.shrink_to_fit();
}

void Picture::add_block(std::span<const GridPoint> all_points, std::span<const Triangle> triangles,
                        std::uint8_t style, std::int32_t base) {
  using Flat = std::array<std::int32_t, 2>;
  std::vector<Flat> points;
  double area = 0, height = 0;  // of what faces up: area in plan, and z weighted by it
  for (const GridPoint& p : all_points)
    points.push_back({static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y)});
  for (const Triangle& t : triangles) {
    const Point3 a = to_metres(all_points[t[0]]), b = to_metres(all_points[t[1]]),
                 c = to_metres(all_points[t[2]]);
    const double plan = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (plan <= 0) continue;
    area += plan;
    height += plan * (a.z + b.z + c.z) / 3;
  }
  if (!(area > 0)) return;

  // Convex hull (Andrew 1979), then corners that matter least go until few are left.
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const auto turn = [](const Flat& a, const Flat& b, const Flat& c) {
    return (static_cast<double>(b[0]) - a[0]) * (static_cast<double>(c[1]) - a[1]) -
           (static_cast<double>(b[1]) - a[1]) * (static_cast<double>(c[0]) - a[0]);
  };
  std::vector<Flat> hull;
  const auto extend = [&](const Flat& p, std::size_t fixed) {
    while (hull.size() >= fixed + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Flat& p : points) extend(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size(); i-- > 1;) extend(points[i - 1], lower);
  hull.pop_back();
  if (hull.size() < 3) return;
  constexpr std::size_t kCorners = 10;
  while (hull.size() > kCorners) {
    const std::size_t n = hull.size();
    std::size_t least = 0;
    for (std::size_t i = 1; i < n; ++i)
      if (turn(hull[(i + n - 1) % n], hull[i], hull[(i + 1) % n]) <
          turn(hull[(least + n - 1) % n], hull[least], hull[(least + 1) % n]))
        least = i;
    hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(least));
  }

  DrawnBlock block;
  block.base = base;
  block.top = static_cast<std::int32_t>(std::llround(height / area * kGridStepsPerMetre));
  block.style = style;
  block.size = area * (block.top - base);
  block.order = bodies_;
  block.outline = std::move(hull);
  const auto larger = [](const DrawnBlock& a, const DrawnBlock& b) {
    return a.size != b.size ? a.size > b.size : a.order < b.order;
  };
  block_corners_ += block.outline.size();
  blocks_.push_back(std::move(block));
  std::push_heap(blocks_.begin(), blocks_.end(), larger);
  while (block_corners_ > kMaxBlockCorners) {
    std::pop_heap(blocks_.begin(), blocks_.end(), larger);
    block_corners_ -= blocks_.back().outline.size();
    blocks_.pop_back();
  }
}

void Picture::add(const BuildingBodies& building) {
  const std::uint8_t style = rung_style(building.rung);
  for (const Body& body : building.bodies) {
    if (body.mesh.points.empty()) continue;
    const std::int32_t base = lowest(body.mesh.points);
    if (!as_blocks_) {
      std::vector<DrawnFace> faces = drawn_faces(body.mesh);
      for (DrawnFace& face : faces) face.style = style;
      add_faces(std::move(faces), base);
    }
    add_block(body.mesh.points, body.mesh.triangles, style, base);
    ++bodies_;
  }
}

void Picture::add(const BuildingReport& report, std::span<const SourceBody> sources) {
  std::uint8_t style = gravest(report.issues_before);
  const auto mark = [this](const std::vector<Issue>& issues) {
    for (const Issue& issue : issues)
      if (issue.at && marks_.size() < kMaxMarks) marks_.push_back(*issue.at);
  };
  mark(report.issues_before);
  for (const PartReport& part : report.parts) {
    style = std::max(style, gravest(part.issues_before));
    mark(part.issues_before);
  }
  ++sources_[style];
  for (const SourceBody& source : sources) {
    const Shell& shell = source.shell;
    if (shell.points.empty()) continue;
    const std::int32_t base = lowest(shell.points);
    const std::vector<std::uint8_t> styles(shell.faces.size(), style);
    std::vector<DrawnFace> faces =
        drawn_faces(shell.points, shell.faces, styles, citymesh::style::kOther);
    if (!as_blocks_) add_faces(std::move(faces), base);
    add_block(shell.points, triangles_of(shell), style, base);
    ++bodies_;
  }
}

}  // namespace citymesh
