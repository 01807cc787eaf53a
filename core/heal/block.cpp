#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/geometry/box_tree.h"
#include "core/geometry/overlay.h"
#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"

namespace citymesh {
namespace {

constexpr double kPercentile = 0.7;   ///< of roof area, from below (contract, `on_failure`)
constexpr double kMinHeight_m = 0.5;  ///< a block flatter than this is no building
constexpr double kMinArea_m2 = 0.01;  ///< slivers of an overlay are no footprint
constexpr std::array kOutlines_m{0.01, 0.05, 0.2,
                                 0.5};  ///< tolerances of simpler and simpler outlines

constexpr std::uint64_t kMaxOverlaps =
    200'000;  ///< of boxes of triangles, up to which a footprint is their union

/// Triangles of a face, seen from above, counter-clockwise; vertical ones vanish.
void project_face(const Shell& shell, const Face& face, std::vector<Area>& areas) {
  const auto triangles = triangulate(shell.points, face.rings);
  if (!triangles) return;
  for (const Triangle& t : *triangles) {
    Area area{{project(shell.points[t[0]], Axis::Z), project(shell.points[t[1]], Axis::Z),
               project(shell.points[t[2]], Axis::Z)},
              {}};
    const Int128 twice = area2(area);
    if (twice == 0) continue;
    if (twice < 0) std::swap(area.exterior[1], area.exterior[2]);
    areas.push_back(std::move(area));
  }
}

Area hull_of(const std::vector<Area>& areas) {
  std::vector<GridPoint2> corners;
  for (const Area& area : areas)
    corners.insert(corners.end(), area.exterior.begin(), area.exterior.end());
  return convex_hull(std::move(corners));
}

/// Whether so many areas lie over each other that uniting them would take too long.
bool is_a_tangle(const std::vector<Area>& areas) {
  std::vector<GridBox> boxes;
  boxes.reserve(areas.size());
  for (const Area& area : areas) {
    GridBox box = GridBox::of({area.exterior[0].x, area.exterior[0].y, 0});
    for (const GridPoint2& p : area.exterior) box.add(GridPoint{p.x, p.y, 0});
    boxes.push_back(box);
  }
  const BoxTree tree(boxes);
  std::uint64_t overlaps = 0;
  for (std::size_t i = 0; i < boxes.size() && overlaps <= kMaxOverlaps; ++i)
    tree.for_each_meeting(boxes[i], [&](std::uint32_t) { ++overlaps; });
  return overlaps > kMaxOverlaps;
}

/// Union of the ground faces, else of all faces seen from above.
std::vector<Area> footprint(const Shell& shell) {
  std::vector<Area> ground, all;
  for (const Face& face : shell.faces) {
    if (face.rings.empty()) continue;
    if (face.type == SurfaceType::GroundSurface) project_face(shell, face, ground);
    project_face(shell, face, all);
  }
  for (auto* areas : {&ground, &all}) {
    if (areas->empty()) continue;
    std::sort(areas->begin(), areas->end(),
              [](const Area& a, const Area& b) { return a.exterior < b.exterior; });
    areas->erase(std::unique(areas->begin(), areas->end(),
                             [](const Area& a, const Area& b) { return a.exterior == b.exterior; }),
                 areas->end());
    if (is_a_tangle(*areas)) return {hull_of(*areas)};
    auto united = unite(*areas);
    if (united && !united->empty()) return std::move(*united);
  }
  return {};
}

/// Height below which the given share of the roof area lies.
std::optional<std::int64_t> roof_percentile(const Shell& shell, std::int64_t base) {
  std::vector<std::pair<double, double>> samples;  // z in steps, area
  const auto collect = [&](bool typed_only) {
    for (const Face& face : shell.faces) {
      if (face.rings.empty()) continue;
      if (typed_only ? face.type != SurfaceType::RoofSurface
                     : face.type == SurfaceType::GroundSurface)
        continue;
      const auto triangles = triangulate(shell.points, face.rings);
      if (!triangles) continue;
      for (const Triangle& t : *triangles) {
        const GridPoint &a = shell.points[t[0]], &b = shell.points[t[1]], &c = shell.points[t[2]];
        const double area = std::abs(static_cast<double>(
            area2(project(a, Axis::Z), project(b, Axis::Z), project(c, Axis::Z))));
        const double top = static_cast<double>(std::max({a.z, b.z, c.z}));
        if (area <= 0 || top <= static_cast<double>(base)) continue;
        // 16 congruent pieces resolve a pitched roof; each counts at its centre.
        constexpr int kParts = 4;
        for (int i = 0; i < kParts; ++i)
          for (int j = 0; j < 2 * (kParts - i) - 1; ++j) {
            const int pair = j / 2;
            const double within = (j % 2 ? 2.0 : 1.0) / 3.0;
            const double u = (i + within) / kParts, v = (pair + within) / kParts;
            samples.emplace_back(static_cast<double>(a.z) + u * static_cast<double>(b.z - a.z) +
                                     v * static_cast<double>(c.z - a.z),
                                 area / (kParts * kParts));
          }
      }
    }
  };
  collect(true);
  if (samples.empty()) collect(false);
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  double total = 0, sum = 0;
  for (const auto& [z, area] : samples) total += area;
  for (const auto& [z, area] : samples) {
    sum += area;
    if (sum >= kPercentile * total) return std::llround(z);
  }
  return std::llround(samples.back().first);
}

/// Cuts a small square out where outlines touch in a point: extruded, such a point would be an edge
/// of four walls.
std::vector<Area> without_pinches(std::vector<Area> areas) {
  constexpr std::int64_t kHalfSquare = 200;  // 2 cm, well above every delivery threshold
  for (int round = 0; round < 4; ++round) {
    std::map<GridPoint2, int> visits;
    for (const Area& area : areas) {
      for (const GridPoint2& p : area.exterior) ++visits[p];
      for (const auto& hole : area.holes)
        for (const GridPoint2& p : hole) ++visits[p];
    }
    std::vector<Area> squares;
    const std::int64_t h = kHalfSquare * (round + 1);
    for (const auto& [p, count] : visits)
      if (count > 1)
        squares.push_back(
            {{{p.x - h, p.y - h}, {p.x + h, p.y - h}, {p.x + h, p.y + h}, {p.x - h, p.y + h}}, {}});
    if (squares.empty()) return areas;
    auto rest = subtract(areas, squares);
    if (!rest) return areas;
    areas = std::move(*rest);
  }
  return areas;
}

Shell extrude(const std::vector<Area>& areas, std::int64_t base, std::int64_t top) {
  Shell shell;
  shell.surface_ids.emplace_back();
  const auto add_face = [&](std::vector<Ring> rings, SurfaceType type) {
    Face face;
    face.rings = std::move(rings);
    face.type = type;
    shell.faces.push_back(std::move(face));
  };
  for (const Area& area : areas) {
    std::vector<Ring> floor, roof;
    const auto add_ring = [&](const std::vector<GridPoint2>& points) {
      const auto first = static_cast<std::uint32_t>(shell.points.size());
      const auto n = static_cast<std::uint32_t>(points.size());
      for (const GridPoint2& p : points) shell.points.push_back({p.x, p.y, base});
      for (const GridPoint2& p : points) shell.points.push_back({p.x, p.y, top});
      Ring below, above;
      for (std::uint32_t i = 0; i < n; ++i) {
        below.push_back(first + n - 1 - i);
        above.push_back(first + n + i);
        const std::uint32_t j = (i + 1) % n;
        add_face({{first + i, first + j, first + n + j, first + n + i}}, SurfaceType::WallSurface);
      }
      floor.push_back(std::move(below));
      roof.push_back(std::move(above));
    };
    add_ring(area.exterior);
    for (const auto& hole : area.holes) add_ring(hole);
    add_face(std::move(floor), SurfaceType::GroundSurface);
    add_face(std::move(roof), SurfaceType::RoofSurface);
  }
  return shell;
}

}  // namespace

std::string lod1_block(const Shell& shell, bool footprint_only,
                       std::optional<double> measured_height_m,
                       const std::function<bool(Shell&)>& take) {
  std::set<std::uint32_t> used;
  for (const Face& face : shell.faces)
    for (const Ring& ring : face.rings) used.insert(ring.begin(), ring.end());
  if (used.empty()) return "no_geometry";
  std::int64_t base = shell.points[*used.begin()].z;
  for (const std::uint32_t i : used) base = std::min(base, shell.points[i].z);

  std::optional<std::int64_t> top;
  if (!footprint_only) top = roof_percentile(shell, base);
  const auto min_height = static_cast<std::int64_t>(kMinHeight_m * kGridStepsPerMetre);
  if ((!top || *top - base < min_height) && measured_height_m &&
      *measured_height_m >= kMinHeight_m && *measured_height_m < 2000)
    top = base + std::llround(*measured_height_m * kGridStepsPerMetre);
  if (!top || *top - base < min_height) return "no_height";

  const std::vector<Area> whole = footprint(shell);
  if (whole.empty()) return "no_geometry";
  std::string reason = "no_geometry";
  const auto offer = [&](std::vector<Area> areas) {
    std::erase_if(areas, [](const Area& area) {
      return static_cast<double>(area2(area)) <
             2 * kMinArea_m2 * kGridStepsPerMetre * kGridStepsPerMetre;
    });
    if (areas.empty()) return false;
    reason = "not_healed";
    Shell block = extrude(without_pinches(std::move(areas)), base, *top);
    return take(block);
  };
  if (offer(whole)) return "";
  for (const double tolerance_m : kOutlines_m) {
    const auto smoother = smooth(whole, tolerance_m);
    if (!smoother) continue;
    auto simpler = simplify(*smoother, tolerance_m);
    if (simpler && offer(std::move(*simpler))) return "";
  }
  if (Area hull = hull_of(whole); !hull.exterior.empty() && offer({std::move(hull)})) return "";
  return reason;
}

}  // namespace citymesh
