#include "core/geometry/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace citymesh {
namespace {

Point3 difference(const GridPoint& a, const GridPoint& b) {
  return {static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y),
          static_cast<double>(a.z - b.z)};
}
double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Point3& a) { return std::sqrt(dot(a, a)); }

/// Many copies of one triangle would all be nearest.
std::vector<Triangle> each_once(std::span<const Triangle> triangles) {
  std::vector<Triangle> sorted(triangles.begin(), triangles.end());
  for (Triangle& t : sorted) std::sort(t.begin(), t.end());
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  return sorted;
}

constexpr std::size_t kSamplesPerTriangle = 7;

std::array<GridPoint, 3> corners_of(std::span<const GridPoint> points, const Triangle& t) {
  std::array<GridPoint, 3> corners{points[t[0]], points[t[1]], points[t[2]]};
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace

Int128 volume6(std::span<const GridPoint> points, std::span<const Triangle> triangles) {
  Int128 sum = 0;
  if (triangles.empty()) return sum;
  const GridPoint& apex = points[triangles[0][0]];
  for (const Triangle& t : triangles)
    sum += volume6(points[t[0]], points[t[2]], points[t[1]], apex);
  return sum;
}

double volume_m3(std::span<const GridPoint> points, std::span<const Triangle> triangles) {
  constexpr double kStepsCubed = kGridStepsPerMetre * kGridStepsPerMetre * kGridStepsPerMetre;
  return static_cast<double>(volume6(points, triangles)) / 6.0 / kStepsCubed;
}

double area_m2(std::span<const GridPoint> points, std::span<const Triangle> triangles) {
  double sum = 0;
  for (const Triangle& t : triangles)
    sum += length(normal_of(points[t[0]], points[t[1]], points[t[2]]));
  return sum / 2.0 / (kGridStepsPerMetre * kGridStepsPerMetre);
}

double distance_m(const GridPoint& a, const GridPoint& b) {
  return length(difference(a, b)) * kGridStep_m;
}

double distance_to_segment_m(const GridPoint& p, const GridPoint& a, const GridPoint& b,
                             double* position) {
  const Point3 ab = difference(b, a), ap = difference(p, a);
  const double squared = dot(ab, ab);
  const double t = squared > 0 ? std::clamp(dot(ap, ab) / squared, 0.0, 1.0) : 0.0;
  if (position) *position = t;
  const Point3 off{ap.x - t * ab.x, ap.y - t * ab.y, ap.z - t * ab.z};
  return length(off) * kGridStep_m;
}

double distance_to_triangle_m(const GridPoint& p, const GridPoint& a, const GridPoint& b,
                              const GridPoint& c) {
  const Point3 n = normal_of(a, b, c);
  const double squared = dot(n, n);
  const Point3 ap = difference(p, a);
  if (squared > 0) {
    // Inside the prism over the triangle: the distance is that to the plane.
    const auto side = [&](const GridPoint& u, const GridPoint& v) {
      const Point3 uv = difference(v, u), up = difference(p, u);
      const Point3 cross{uv.y * up.z - uv.z * up.y, uv.z * up.x - uv.x * up.z,
                         uv.x * up.y - uv.y * up.x};
      return dot(cross, n);
    };
    if (side(a, b) >= 0 && side(b, c) >= 0 && side(c, a) >= 0)
      return std::abs(dot(ap, n)) / std::sqrt(squared) * kGridStep_m;
  }
  return std::min({distance_to_segment_m(p, a, b), distance_to_segment_m(p, b, c),
                   distance_to_segment_m(p, c, a)});
}

GridBox box_of(std::span<const GridPoint> points, const Triangle& triangle) {
  GridBox box = GridBox::of(points[triangle[0]]);
  box.add(points[triangle[1]]);
  box.add(points[triangle[2]]);
  return box;
}

std::vector<GridBox> boxes_of(std::span<const GridPoint> points,
                              std::span<const Triangle> triangles) {
  std::vector<GridBox> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& t : triangles) boxes.push_back(box_of(points, t));
  return boxes;
}

DistanceField::DistanceField(std::span<const GridPoint> points, std::span<const Triangle> triangles)
    : points_(points.begin(), points.end()),
      triangles_(each_once(triangles)),
      tree_(boxes_of(points, triangles_)) {}

double DistanceField::distance_m(const GridPoint& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  tree_.for_each_nearer(p, [&](std::uint32_t i) {
    const Triangle& t = triangles_[i];
    nearest =
        std::min(nearest, distance_to_triangle_m(p, points_[t[0]], points_[t[1]], points_[t[2]]));
    const double steps = nearest * kGridStepsPerMetre;
    return steps * steps;
  });
  return nearest;
}

Deviation deviation_to(const TriangleView& from, const TriangleView& to) {
  if (from.triangles.empty() || to.triangles.empty()) return {};
  // Most triangles of a healed surface are the source's own: those need no search.
  std::vector<std::array<GridPoint, 3>> known;
  known.reserve(to.triangles.size());
  for (const Triangle& t : to.triangles) known.push_back(corners_of(to.points, t));
  std::sort(known.begin(), known.end());
  std::optional<DistanceField> field;

  Deviation result;
  double sum = 0;
  for (const Triangle& t : from.triangles) {
    if (std::binary_search(known.begin(), known.end(), corners_of(from.points, t))) continue;
    if (!field) field.emplace(to.points, to.triangles);
    const GridPoint &a = from.points[t[0]], &b = from.points[t[1]], &c = from.points[t[2]];
    const GridPoint samples[kSamplesPerTriangle]{
        a,
        b,
        c,
        {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2},
        {(b.x + c.x) / 2, (b.y + c.y) / 2, (b.z + c.z) / 2},
        {(c.x + a.x) / 2, (c.y + a.y) / 2, (c.z + a.z) / 2},
        {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3}};
    for (const GridPoint& p : samples) {
      const double d = field->distance_m(p);
      result.max_m = std::max(result.max_m, d);
      sum += d;
    }
  }
  result.mean_m = sum / static_cast<double>(kSamplesPerTriangle * from.triangles.size());
  return result;
}

Deviation two_sided(const Deviation& a, const Deviation& b) {
  return {std::max(a.max_m, b.max_m), (a.mean_m + b.mean_m) / 2};
}

}  // namespace citymesh
