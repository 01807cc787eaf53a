#include "core/reconstruct/push_out.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/geometry/box_tree.h"
#include "core/geometry/locate.h"

namespace citymesh {
namespace {

Point3 in_steps(const GridPoint& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}
GridPoint rounded(const Point3& p) {
  return {std::llround(p.x), std::llround(p.y), std::llround(p.z)};
}
Point3 minus(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point3 plus(const Point3& a, double t, const Point3& b) {
  return {a.x + t * b.x, a.y + t * b.y, a.z + t * b.z};
}
double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Plane {
  Point3 normal{};  ///< unit length
  Point3 through{};
  double height(const Point3& p) const { return dot(normal, minus(p, through)); }
};

struct Place {
  Point3 at{};
  std::vector<Plane> planes{};  ///< of faces of the other within reach
};

class Other {
 public:
  Other(const TriangleView& surface, double reach_m)
      : surface_(surface),
        reach_m_(reach_m),
        locator_(surface.points, surface.triangles),
        tree_(boxes_of(surface.points, surface.triangles)) {}

  /// Places along the way from a to b, one between any two crossings of faces, that lie inside.
  std::vector<Place> inside_along(const GridPoint& a, const GridPoint& b) const {
    const Point3 start = in_steps(a), way = minus(in_steps(b), start);
    std::vector<double> cuts{0, 1};
    GridBox box = GridBox::of(a);
    box.add(b);
    tree_.for_each_meeting(box.grown(1), [&](std::uint32_t f) {
      const Plane plane = plane_of(f);
      const double from = plane.height(start), change = dot(plane.normal, way);
      const double t = change == 0 ? 0 : -from / change;
      if (t > 0 && t < 1) cuts.push_back(t);
    });
    std::sort(cuts.begin(), cuts.end());
    std::vector<Place> inside;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      Place place = place_at(plus(start, (cuts[i] + cuts[i + 1]) / 2, way));
      if (is_inside(place)) inside.push_back(std::move(place));
    }
    return inside;
  }

 private:
  Place place_at(const Point3& at) const {
    Place place{at};
    const GridPoint near = rounded(at);
    const auto reach = static_cast<std::int64_t>(std::ceil(reach_m_ * kGridStepsPerMetre)) + 1;
    tree_.for_each_meeting(GridBox::of(near).grown(reach), [&](std::uint32_t f) {
      const Triangle& t = surface_.triangles[f];
      const auto& p = surface_.points;
      if (distance_to_triangle_m(near, p[t[0]], p[t[1]], p[t[2]]) <= reach_m_ + kGridStep_m)
        place.planes.push_back(plane_of(f));
    });
    return place;
  }

  /// Less than a step under a face a place of the grid tells nothing.
  bool is_inside(const Place& place) const {
    constexpr double kNothing = 1e-3;
    if (locator_.locate(rounded(place.at)) == Side::Inside) return true;
    return std::any_of(place.planes.begin(), place.planes.end(), [&](const Plane& plane) {
      const double height = plane.height(place.at);
      return height < -kNothing && height > -1;
    });
  }

  Plane plane_of(std::uint32_t f) const {
    const Triangle& t = surface_.triangles[f];
    const auto& p = surface_.points;
    const Point3 n = normal_of(p[t[0]], p[t[1]], p[t[2]]);
    const double length = std::sqrt(dot(n, n));
    return {{n.x / length, n.y / length, n.z / length}, in_steps(p[t[0]])};
  }

  TriangleView surface_;
  double reach_m_;
  Locator locator_;
  BoxTree tree_;
};

/// A corner that has to be outside of a plane.
struct Demand {
  std::uint32_t corner;
  Plane plane;
};

std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_of(std::span<const Triangle> triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back(std::minmax({t[i], t[(i + 1) % 3]}));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

std::optional<PushedOut> push_out(const TriangleView& body, const TriangleView& other,
                                  double reach_m, double clearance) {
  if (other.triangles.empty()) return {};
  const Other obstacle(other, reach_m);
  GridBox box = box_of(other.points, other.triangles[0]);
  for (const Triangle& t : other.triangles) box.add(box_of(other.points, t));

  std::vector<Demand> demands;
  for (const auto& [from, to] : edges_of(body.triangles)) {
    GridBox of_edge = GridBox::of(body.points[from]);
    of_edge.add(body.points[to]);
    if (!of_edge.meets(box)) continue;
    const Point3 a = in_steps(body.points[from]), b = in_steps(body.points[to]);
    for (const Place& place : obstacle.inside_along(body.points[from], body.points[to])) {
      // Out through the face that asks least of the two ends.
      const Plane* best = nullptr;
      double least = reach_m * kGridStepsPerMetre;
      for (const Plane& plane : place.planes) {
        const double depth = -std::min(plane.height(a), plane.height(b));
        if (depth > least) continue;
        least = depth;
        best = &plane;
      }
      if (!best) return {};
      for (const std::uint32_t corner : {from, to})
        if (best->height(in_steps(body.points[corner])) < clearance)
          demands.push_back({corner, *best});
    }
  }
  if (demands.empty()) return {};

  // A corner between two faces moves along both; turns with each other end in their edge.
  constexpr int kTurns = 8;
  std::vector<Point3> moved;
  moved.reserve(body.points.size());
  for (const GridPoint& p : body.points) moved.push_back(in_steps(p));
  for (int turn = 0; turn < kTurns; ++turn)
    for (const Demand& demand : demands)
      if (const double height = demand.plane.height(moved[demand.corner]); height < clearance)
        moved[demand.corner] = plus(moved[demand.corner], clearance - height, demand.plane.normal);

  PushedOut result;
  result.points.reserve(moved.size());
  for (std::size_t v = 0; v < moved.size(); ++v) {
    result.points.push_back(rounded(moved[v]));
    const double displacement_m = distance_m(result.points[v], body.points[v]);
    if (displacement_m > reach_m + 2 * clearance * kGridStep_m) return {};
    if (displacement_m <= result.displacement_m) continue;
    result.displacement_m = displacement_m;
    result.at = body.points[v];
  }
  if (result.displacement_m == 0) return {};
  return result;
}

}  // namespace citymesh
