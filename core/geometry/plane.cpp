#include "core/geometry/plane.h"

#include <array>
#include <cmath>
#include <utility>

namespace citymesh {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Turns the axes p and q so that a[p][q] becomes zero (Jacobi 1846); v collects the turns.
void rotate(Matrix& a, Matrix& v, std::size_t p, std::size_t q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  for (std::size_t k = 0; k < 3; ++k) {
    const double kp = a[k][p], kq = a[k][q];
    a[k][p] = c * kp - s * kq;
    a[k][q] = s * kp + c * kq;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double pk = a[p][k], qk = a[q][k];
    a[p][k] = c * pk - s * qk;
    a[q][k] = s * pk + c * qk;
    const double vp = v[k][p], vq = v[k][q];
    v[k][p] = c * vp - s * vq;
    v[k][q] = s * vp + c * vq;
  }
}

}  // namespace

Plane fit_plane(std::span<const Point3> points) {
  Plane plane;
  plane.normal = {0, 0, 1};
  if (points.empty()) return plane;
  const auto count = static_cast<double>(points.size());
  Point3 mean{};
  for (const Point3& p : points) mean = {mean.x + p.x, mean.y + p.y, mean.z + p.z};
  plane.origin = {mean.x / count, mean.y / count, mean.z / count};

  Matrix spread{};
  for (const Point3& p : points) {
    const std::array<double, 3> d{p.x - plane.origin.x, p.y - plane.origin.y, p.z - plane.origin.z};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) spread[i][j] += d[i] * d[j];
  }
  Matrix axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  constexpr int kSweeps = 12;  // converges quadratically: five are usual
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    rotate(spread, axes, 0, 1);
    rotate(spread, axes, 0, 2);
    rotate(spread, axes, 1, 2);
  }
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (spread[i][i] < spread[least][least]) least = i;
  plane.normal = {axes[0][least], axes[1][least], axes[2][least]};
  return plane;
}

double signed_distance(const Plane& plane, const Point3& p) {
  return plane.normal.x * (p.x - plane.origin.x) + plane.normal.y * (p.y - plane.origin.y) +
         plane.normal.z * (p.z - plane.origin.z);
}

}  // namespace citymesh
