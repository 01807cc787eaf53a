#include "core/validate/polygons.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core/geometry/plane.h"
#include "core/geometry/triangulation.h"
#include "core/validate/ring_pairs.h"
#include "core/validate/rings.h"

namespace citymesh {
namespace {

Int128 twice_area(const FlatRing& ring) {
  Int128 sum = 0;
  for (std::size_t i = 2; i < ring.size(); ++i) sum += area2(ring[0], ring[i - 1], ring[i]);
  return sum;
}

/// Corners of all rings in metres from the first one, so that the place in the world changes
/// nothing.
std::vector<Point3> corners_of(const Boundary& boundary, const TestedPolygon& polygon) {
  const GridPoint& base = boundary.points[polygon.rings[0][0]];
  std::vector<Point3> corners;
  for (const Ring& ring : polygon.rings)
    for (const std::uint32_t i : ring) {
      const GridPoint& p = boundary.points[i];
      corners.push_back(to_metres({p.x - base.x, p.y - base.y, p.z - base.z}));
    }
  return corners;
}

/// Whether all corners lie in one plane; exact. Such a polygon looks the same in all projections.
bool is_plane(const Boundary& boundary, const TestedPolygon& polygon) {
  const Ring& ring = polygon.rings[0];
  if (polygon.rings.size() == 1 && ring.size() == 3) return true;
  const GridPoint &a = boundary.points[ring[0]], &b = boundary.points[ring[1]];
  std::size_t third = 2;
  const auto on_line = [&](const GridPoint& c) {
    return std::ranges::all_of(std::array{Axis::X, Axis::Y, Axis::Z}, [&](Axis axis) {
      return orient2d(project(a, axis), project(b, axis), project(c, axis)) == 0;
    });
  };
  while (third + 1 < ring.size() && on_line(boundary.points[ring[third]])) ++third;
  const GridPoint& c = boundary.points[ring[third]];
  for (const Ring& other : polygon.rings)
    for (const std::uint32_t i : other)
      if (orient3d(a, b, c, boundary.points[i]) != 0) return false;
  return true;
}

/// A polygon as it is seen along the normal of its fitted plane, where other readers look at it. In
/// its own fine grid; z is 0.
struct SeenPolygon {
  std::vector<GridPoint> points{};
  std::vector<Ring> rings{};
  std::vector<std::uint32_t> corner_of{};  ///< of each point: the one of the boundary
};

SeenPolygon seen_along_normal(const Boundary& boundary, const TestedPolygon& polygon) {
  const std::vector<Point3> corners = corners_of(boundary, polygon);
  const Point3 n = fit_plane(corners).normal;
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  Point3 u = x <= y && x <= z ? Point3{0, -n.z, n.y}
             : y <= z         ? Point3{n.z, 0, -n.x}
                              : Point3{-n.y, n.x, 0};
  const double length = std::hypot(u.x, u.y, u.z);
  u = {u.x / length, u.y / length, u.z / length};
  const Point3 v{n.y * u.z - n.z * u.y, n.z * u.x - n.x * u.z, n.x * u.y - n.y * u.x};
  double size = 0;
  for (const Point3& p : corners)
    size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  // As fine as the exact predicates allow: of a roof well below a micrometre.
  const double steps = static_cast<double>(kGridLimit) / (4 * std::max(size, kGridStep_m));

  SeenPolygon seen;
  std::map<std::uint32_t, std::uint32_t> number_of;
  std::size_t next = 0;
  for (const Ring& ring : polygon.rings) {
    Ring& numbers = seen.rings.emplace_back();
    for (const std::uint32_t corner : ring) {
      const Point3& p = corners[next++];
      const auto [at, is_new] =
          number_of.emplace(corner, static_cast<std::uint32_t>(seen.points.size()));
      if (is_new) {
        seen.points.push_back({std::llround((p.x * u.x + p.y * u.y + p.z * u.z) * steps),
                               std::llround((p.x * v.x + p.y * v.y + p.z * v.z) * steps), 0});
        seen.corner_of.push_back(corner);
      }
      numbers.push_back(at->second);
    }
  }
  return seen;
}

class PolygonCheck {
 public:
  PolygonCheck(const Boundary& boundary, const TestedPolygon& polygon,
               const ValidateOptions& options, Findings& findings)
      : boundary_(boundary), polygon_(polygon), options_(options), findings_(findings) {}

  bool run() {
    if (!check_corners(boundary_, polygon_, findings_) || !check_flatness()) return false;
    const Axis axis = dominant_axis(ring_normal(boundary_.points, polygon_.rings[0]));
    see(polygon_.rings, boundary_.points, axis);
    if (!check_rings() || !check_directions() || !check_ring_pairs()) return false;
    if (is_plane(boundary_, polygon_)) return true;
    const SeenPolygon seen = seen_along_normal(boundary_, polygon_);
    see(seen.rings, seen.points, Axis::Z);
    return check_rings() && check_directions() && check_ring_pairs();
  }

 private:
  void see(std::span<const Ring> rings, std::span<const GridPoint> points, Axis axis) {
    flat_.clear();
    for (const Ring& ring : rings) {
      FlatRing& flat = flat_.emplace_back();
      for (const std::uint32_t i : ring) flat.push_back(project(points[i], axis));
    }
  }

  bool report(int code, std::size_t ring, const GridPoint& place, double measured) {
    findings_.add(
        code,
        [&] {
          const std::string label = boundary_.label(polygon_);
          return polygon_.rings.size() == 1 ? label : fmt::format("{} ring {}", label, ring);
        },
        measured, to_metres(place));
    return false;
  }

  const GridPoint& corner(std::size_t ring, std::size_t i) const {
    const Ring& corners = polygon_.rings[ring];
    return boundary_.points[corners[i % corners.size()]];
  }

  /// 203.
  bool check_flatness() {
    if (polygon_.rings.size() == 1 && polygon_.rings[0].size() == 3) return true;
    const GridPoint& base = corner(0, 0);
    const std::vector<Point3> corners = corners_of(boundary_, polygon_);
    const Plane plane = fit_plane(corners);
    std::size_t furthest = 0;
    double largest_m = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (const double distance_m = std::abs(signed_distance(plane, corners[i]));
          distance_m > largest_m) {
        largest_m = distance_m;
        furthest = i;
      }
    if (largest_m <= options_.planarity_tolerance_m) return true;
    const Point3 origin = to_metres(base);
    const Point3& p = corners[furthest];
    findings_.add(
        203, [&] { return boundary_.label(polygon_); }, largest_m,
        Point3{origin.x + p.x, origin.y + p.y, origin.z + p.z});
    return false;
  }

  /// 104.
  bool check_rings() {
    for (std::size_t r = 0; r < polygon_.rings.size(); ++r) {
      const FlatRing& flat = flat_[r];
      if (const auto crossing = find_crossing(flat)) {
        const GridPoint& place =
            corner(r, crossing->edge + (crossing->other == crossing->edge + 1));
        return report(104, r, place, 0);
      }
      if (twice_area(flat) == 0) return report(104, r, corner(r, 0), 0);
    }
    return true;
  }

  /// 208: a hole runs against its exterior.
  bool check_directions() {
    const int exterior = sign(twice_area(flat_[0]));
    for (std::size_t r = 1; r < flat_.size(); ++r)
      if (sign(twice_area(flat_[r])) == exterior) return report(208, r, corner(r, 0), 0);
    return true;
  }

  bool check_ring_pairs() {
    const auto found = find_ring_defect(flat_);
    if (!found) return true;
    constexpr int kCodes[]{201, 202, 206, 207, 205};  // in the order of RingDefect
    return report(kCodes[static_cast<int>(found->defect)], found->ring,
                  lifted(found->ring, found->place), 0);
  }

  /// The corner of the ring that is seen at `place`, else its nearest one.
  GridPoint lifted(std::size_t ring, const GridPoint2& place) const {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < flat_[ring].size(); ++i) {
      const double d = std::hypot(static_cast<double>(flat_[ring][i].x - place.x),
                                  static_cast<double>(flat_[ring][i].y - place.y));
      if (d < least) least = d, nearest = i;
    }
    return corner(ring, nearest);
  }

  const Boundary& boundary_;
  const TestedPolygon& polygon_;
  const ValidateOptions& options_;
  Findings& findings_;
  std::vector<FlatRing> flat_;  ///< the rings as they are seen in the projection under test
};

/// Sound rings may touch each other within an edge: there it gets the corner that touches it.
std::vector<Ring> with_touching_corners(const Boundary& boundary, const TestedPolygon& polygon) {
  struct Edge {
    std::size_t ring = 0, first = 0;
  };
  const Axis axis = dominant_axis(ring_normal(boundary.points, polygon.rings[0]));
  const auto flat = [&](std::uint32_t corner) { return project(boundary.points[corner], axis); };
  std::vector<Edge> edges;
  std::vector<GridBox> boxes;
  for (std::size_t r = 0; r < polygon.rings.size(); ++r) {
    const Ring& ring = polygon.rings[r];
    for (std::size_t i = 0; i < ring.size(); ++i) {
      edges.push_back({r, i});
      boxes.push_back(box_of(flat(ring[i]), flat(ring[(i + 1) % ring.size()])));
    }
  }
  const BoxTree tree(boxes);
  std::vector<std::vector<std::uint32_t>> on(edges.size());
  for (std::size_t r = 0; r < polygon.rings.size(); ++r)
    for (const std::uint32_t corner : polygon.rings[r])
      tree.for_each_meeting(box_of(flat(corner), flat(corner)), [&](std::uint32_t e) {
        if (edges[e].ring == r) return;
        const Ring& ring = polygon.rings[edges[e].ring];
        const std::uint32_t a = ring[edges[e].first], b = ring[(edges[e].first + 1) % ring.size()];
        if (a != corner && b != corner && orient2d(flat(a), flat(b), flat(corner)) == 0)
          on[e].push_back(corner);
      });
  std::vector<Ring> rings(polygon.rings.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const GridPoint2 start = flat(polygon.rings[edges[e].ring][edges[e].first]);
    const auto away = [&](std::uint32_t corner) {
      const GridPoint2 p = flat(corner);
      return std::abs(p.x - start.x) + std::abs(p.y - start.y);
    };
    std::sort(on[e].begin(), on[e].end(),
              [&](std::uint32_t a, std::uint32_t b) { return away(a) < away(b); });
    on[e].erase(std::unique(on[e].begin(), on[e].end()), on[e].end());
    Ring& ring = rings[edges[e].ring];
    ring.push_back(polygon.rings[edges[e].ring][edges[e].first]);
    ring.insert(ring.end(), on[e].begin(), on[e].end());
  }
  return rings;
}

double angle_deg(const Point3& a, const Point3& b) {
  const Point3 cross{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  return std::atan2(std::hypot(cross.x, cross.y, cross.z), a.x * b.x + a.y * b.y + a.z * b.z) *
         180 / std::numbers::pi;
}

/// Whether a triangle is so flat that the fine grid may have made it.
bool is_rounding(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  constexpr double kMinHeight_steps = 4;
  const auto side = [](const GridPoint& p, const GridPoint& q) {
    return std::hypot(static_cast<double>(p.x - q.x), static_cast<double>(p.y - q.y));
  };
  const double twice_area =
      std::abs(static_cast<double>(area2({a.x, a.y}, {b.x, b.y}, {c.x, c.y})));
  return twice_area < kMinHeight_steps * std::max({side(a, b), side(b, c), side(c, a)});
}

/// The triangles into which readers may cut a polygon that is not quite plane, besides
/// `triangles`: seen along its normal, and a quadrilateral along either diagonal.
std::vector<Triangle> all_cuts(const Boundary& boundary, const TestedPolygon& polygon,
                               std::span<const Triangle> triangles) {
  std::vector<Triangle> cuts(triangles.begin(), triangles.end());
  const SeenPolygon seen = seen_along_normal(boundary, polygon);
  const auto add = [&](std::span<const Triangle> others) {
    for (const Triangle& t : others)
      if (!is_rounding(seen.points[t[0]], seen.points[t[1]], seen.points[t[2]]))
        cuts.push_back({seen.corner_of[t[0]], seen.corner_of[t[1]], seen.corner_of[t[2]]});
  };
  if (const auto others = triangulate(seen.points, seen.rings)) add(*others);
  if (polygon.rings.size() == 1 && seen.points.size() == 4) {
    const std::array<Triangle, 4> halves{{{0, 1, 2}, {0, 2, 3}, {1, 2, 3}, {1, 3, 0}}};
    const auto turn = [&](const Triangle& t) {
      const auto corner = [&](std::size_t i) { return project(seen.points[t[i]], Axis::Z); };
      return orient2d(corner(0), corner(1), corner(2));
    };
    const bool convex = std::ranges::all_of(
        halves, [&](const Triangle& t) { return turn(t) != 0 && turn(t) == turn(halves[0]); });
    if (convex) add(halves);
  }
  return cuts;
}

/// 204: largest angle between two triangles of a polygon.
bool check_normals(const Boundary& boundary, const TestedPolygon& polygon,
                   std::span<const Triangle> triangles, const ValidateOptions& options,
                   Findings& findings) {
  if (is_plane(boundary, polygon)) return true;
  const std::vector<Triangle> cuts = all_cuts(boundary, polygon, triangles);
  std::vector<Point3> normals;
  std::size_t largest = 0;
  const auto length = [](const Point3& n) { return std::hypot(n.x, n.y, n.z); };
  for (const Triangle& t : cuts) {
    normals.push_back(
        normal_of(boundary.points[t[0]], boundary.points[t[1]], boundary.points[t[2]]));
    if (length(normals.back()) > length(normals[largest])) largest = normals.size() - 1;
  }
  // Two that differ by more than the limit: one of them differs from the largest by half of it.
  std::vector<std::size_t> turned;
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (angle_deg(normals[largest], normals[i]) > options.planarity_angle_deg / 2)
      turned.push_back(i);
  double widest_deg = 0;
  std::size_t widest = 0;
  constexpr std::size_t kMaxTurned = 1000;
  if (turned.size() > kMaxTurned) turned.resize(kMaxTurned);
  for (const std::size_t i : turned)
    for (const Point3& other : normals)
      if (const double angle = angle_deg(normals[i], other); angle > widest_deg) {
        widest_deg = angle;
        widest = i;
      }
  if (widest_deg <= options.planarity_angle_deg) return true;
  findings.add(
      204, [&] { return boundary.label(polygon); }, widest_deg,
      to_metres(boundary.points[cuts[widest][0]]));
  return false;
}

/// Triangles of a sound polygon. None: it is beyond CGAL's numbers.
std::optional<std::vector<Triangle>> triangles_of(const Boundary& boundary,
                                                  const TestedPolygon& polygon) {
  auto triangles = triangulate(boundary.points, polygon.rings);
  if (!triangles && polygon.rings.size() > 1)
    triangles = triangulate(boundary.points, with_touching_corners(boundary, polygon));
  return triangles;
}

}  // namespace

std::vector<bool> sound_polygons(const Boundary& boundary, const ValidateOptions& options) {
  std::vector<bool> sound;
  Findings findings;
  for (const TestedPolygon& polygon : boundary.polygons) {
    bool good = PolygonCheck(boundary, polygon, options, findings).run();
    if (good && !is_plane(boundary, polygon)) {
      const auto triangles = triangles_of(boundary, polygon);
      good = triangles && check_normals(boundary, polygon, *triangles, options, findings);
    }
    sound.push_back(good);
  }
  return sound;
}

bool check_polygons(Boundary& boundary, const ValidateOptions& options, Findings& findings) {
  bool sound = true;
  for (const TestedPolygon& polygon : boundary.polygons)
    sound = PolygonCheck(boundary, polygon, options, findings).run() && sound;
  if (!sound) return false;
  for (std::uint32_t p = 0; p < boundary.polygons.size(); ++p) {
    const TestedPolygon& polygon = boundary.polygons[p];
    const auto triangles = triangles_of(boundary, polygon);
    if (!triangles) {  // sound rings can always be cut, unless they are beyond CGAL's numbers
      findings.add(
          104, [&] { return boundary.label(polygon); }, 0,
          to_metres(boundary.points[polygon.rings[0][0]]));
      sound = false;
      continue;
    }
    sound = check_normals(boundary, polygon, *triangles, options, findings) && sound;
    boundary.triangles.insert(boundary.triangles.end(), triangles->begin(), triangles->end());
    boundary.polygon_of.insert(boundary.polygon_of.end(), triangles->size(), p);
  }
  return sound;
}

}  // namespace citymesh
