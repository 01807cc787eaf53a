#include "core/validate/polygons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

class PolygonCheck {
 public:
  PolygonCheck(const Boundary& boundary, const TestedPolygon& polygon,
               const ValidateOptions& options, Findings& findings)
      : boundary_(boundary), polygon_(polygon), options_(options), findings_(findings) {}

  bool run() {
    return check_corners(boundary_, polygon_, findings_) && check_flatness() && check_rings() &&
           check_directions() && check_ring_pairs();
  }

 private:
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

  /// 203. Coordinates count from the first corner, so that the place in the world changes nothing.
  bool check_flatness() {
    if (polygon_.rings.size() == 1 && polygon_.rings[0].size() == 3) return true;
    const GridPoint& base = corner(0, 0);
    std::vector<Point3> corners;
    for (const Ring& ring : polygon_.rings)
      for (const std::uint32_t i : ring) {
        const GridPoint& p = boundary_.points[i];
        corners.push_back(to_metres({p.x - base.x, p.y - base.y, p.z - base.z}));
      }
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

  /// 104, in the projection in which the polygon will be cut into triangles.
  bool check_rings() {
    axis_ = dominant_axis(ring_normal(boundary_.points, polygon_.rings[0]));
    for (std::size_t r = 0; r < polygon_.rings.size(); ++r) {
      FlatRing& flat = flat_.emplace_back();
      for (const std::uint32_t i : polygon_.rings[r])
        flat.push_back(project(boundary_.points[i], axis_));
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
  Axis axis_ = Axis::Z;
  std::vector<FlatRing> flat_;
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

/// 204: largest angle between the largest triangle of a polygon and another one.
bool check_normals(const Boundary& boundary, const TestedPolygon& polygon,
                   std::span<const Triangle> triangles, const ValidateOptions& options,
                   Findings& findings) {
  std::vector<Point3> normals;
  std::size_t largest = 0;
  const auto length = [](const Point3& n) { return std::hypot(n.x, n.y, n.z); };
  for (const Triangle& t : triangles) {
    normals.push_back(
        normal_of(boundary.points[t[0]], boundary.points[t[1]], boundary.points[t[2]]));
    if (length(normals.back()) > length(normals[largest])) largest = normals.size() - 1;
  }
  double widest_deg = 0;
  std::size_t widest = 0;
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (const double angle = angle_deg(normals[largest], normals[i]); angle > widest_deg) {
      widest_deg = angle;
      widest = i;
    }
  if (widest_deg <= options.planarity_angle_deg) return true;
  findings.add(
      204, [&] { return boundary.label(polygon); }, widest_deg,
      to_metres(boundary.points[triangles[widest][0]]));
  return false;
}

}  // namespace

bool check_polygons(Boundary& boundary, const ValidateOptions& options, Findings& findings) {
  bool sound = true;
  for (const TestedPolygon& polygon : boundary.polygons)
    sound = PolygonCheck(boundary, polygon, options, findings).run() && sound;
  if (!sound) return false;
  for (std::uint32_t p = 0; p < boundary.polygons.size(); ++p) {
    const TestedPolygon& polygon = boundary.polygons[p];
    auto triangles = triangulate(boundary.points, polygon.rings);
    if (!triangles && polygon.rings.size() > 1)
      triangles = triangulate(boundary.points, with_touching_corners(boundary, polygon));
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
