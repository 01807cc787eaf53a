#include "core/source/placement.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/citymodel/crs.h"

namespace citymesh::source {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == ','; }

double determinant(const std::array<double, 16>& m) {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
         m[2] * (m[4] * m[9] - m[5] * m[8]);
}

}  // namespace

std::optional<std::array<double, 16>> matrix_from(std::string_view text) {
  std::array<double, 16> matrix{};
  std::size_t count = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    while (at != end && is_blank(*at)) ++at;
    if (at == end) break;
    if (*at == '+') ++at;
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !std::isfinite(value) || count == matrix.size())
      return std::nullopt;
    matrix[count++] = value;
    at = stop;
  }
  if (count != matrix.size() || matrix[15] == 0) return std::nullopt;
  return matrix;
}

// Degrees come from the radii of curvature of the GRS80 ellipsoid (Torge 2001, section 4.1.3);
// within the size of a template other ellipsoids do not differ.
Placer::Steps Placer::steps_at(std::string_view srs_name, const Point3& reference) {
  Steps steps;
  const auto crs = parse_crs(srs_name);
  if (!crs || !crs->known()) return steps;
  const auto facts = describe_crs(*crs);
  if (!facts) return steps;
  steps.up = 1 / facts->vertical_unit_m;
  if (!facts->geographic) {
    steps.east = steps.north = 1 / facts->horizontal_unit_m;
    return steps;
  }
  constexpr double kRadius_m = 6378137.0, kEccentricity2 = 0.00669438002290;
  constexpr double kDegree = std::numbers::pi / 180;
  const bool fits_north_first = std::abs(reference.x) <= 90;
  steps.north_first = facts->north_first && fits_north_first;
  const double latitude = (steps.north_first ? reference.x : reference.y) * kDegree;
  const double w2 = 1 - kEccentricity2 * std::sin(latitude) * std::sin(latitude);
  const double meridian_m = kRadius_m * (1 - kEccentricity2) / (w2 * std::sqrt(w2));
  const double normal_m = kRadius_m / std::sqrt(w2);
  steps.north = 1 / (meridian_m * kDegree);
  steps.east = 1 / (normal_m * std::max(std::cos(latitude), 1e-6) * kDegree);
  return steps;
}

Placer::Placer(const Placement& placement, std::string_view srs_name)
    : placement_(placement),
      steps_(steps_at(srs_name, placement.reference)),
      mirrors_(determinant(placement.matrix) / placement.matrix[15] < 0) {}

PolygonUse Placer::copy(const Feature& from, const PolygonUse& use, Feature& to) const {
  const auto& m = placement_.matrix;
  RawPolygon copy = from.polygons[use.polygon];
  const std::uint32_t first_ring = copy.first_ring;
  copy.first_ring = static_cast<std::uint32_t>(to.rings.size());
  copy.srs = placement_.srs;
  for (std::uint32_t r = 0; r < copy.ring_count; ++r) {
    const RawRing ring = from.rings[first_ring + r];
    to.rings.push_back({static_cast<std::uint32_t>(to.points.size()), ring.count});
    for (std::uint32_t p = 0; p < ring.count; ++p) {
      const Point3 local = from.points[ring.first + p];
      const auto row = [&](std::size_t i) {
        return (m[i] * local.x + m[i + 1] * local.y + m[i + 2] * local.z + m[i + 3]) / m[15];
      };
      Point3 step{row(0) * steps_.east, row(4) * steps_.north, row(8) * steps_.up};
      if (steps_.north_first) std::swap(step.x, step.y);
      to.points.push_back({placement_.reference.x + step.x, placement_.reference.y + step.y,
                           placement_.reference.z + step.z});
    }
  }
  to.polygons.push_back(std::move(copy));
  return {.polygon = static_cast<std::uint32_t>(to.polygons.size() - 1),
          .reversed = use.reversed != mirrors_,
          .surface = use.surface};
}

}  // namespace citymesh::source
