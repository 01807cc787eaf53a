#include "core/validate/boundary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace citymesh {
namespace {

/// Gives points their numbers in a boundary, in the order in which they come.
class Snapper {
 public:
  Snapper(std::vector<GridPoint>& points, double tolerance_m)
      : points_(points),
        tolerance2_(tolerance_m * kGridStepsPerMetre * tolerance_m * kGridStepsPerMetre),
        cell_(std::max<std::int64_t>(
            1, static_cast<std::int64_t>(std::ceil(tolerance_m * kGridStepsPerMetre)))) {}

  std::uint32_t number(const GridPoint& p) {
    const GridPoint home{cell_of(p.x), cell_of(p.y), cell_of(p.z)};
    std::uint32_t found = kNone;
    for (std::int64_t x = home.x - 1; x <= home.x + 1; ++x)
      for (std::int64_t y = home.y - 1; y <= home.y + 1; ++y)
        for (std::int64_t z = home.z - 1; z <= home.z + 1; ++z) {
          const auto cell = cells_.find({x, y, z});
          if (cell == cells_.end()) continue;
          for (std::uint32_t i = cell->second; i != kNone; i = next_[i])
            if (i < found && close(points_[i], p)) found = i;
        }
    if (found != kNone) return found;
    const auto made = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    const auto [cell, added] = cells_.emplace(home, made);
    next_.push_back(added ? kNone : cell->second);
    cell->second = made;
    return made;
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  struct Hash {
    std::size_t operator()(const GridPoint& p) const {
      auto h = static_cast<std::uint64_t>(p.x) * 0x9E3779B97F4A7C15ull;
      h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(p.y)) * 0xBF58476D1CE4E5B9ull;
      h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(p.z)) * 0x94D049BB133111EBull;
      return h ^ (h >> 31);
    }
  };

  std::int64_t cell_of(std::int64_t c) const {
    return c >= 0 ? c / cell_ : -((-c + cell_ - 1) / cell_);
  }
  bool close(const GridPoint& a, const GridPoint& b) const {
    if (a == b) return true;
    const auto x = static_cast<double>(a.x - b.x), y = static_cast<double>(a.y - b.y),
               z = static_cast<double>(a.z - b.z);
    return x * x + y * y + z * z < tolerance2_;
  }

  std::vector<GridPoint>& points_;
  double tolerance2_;                                         ///< steps²
  std::int64_t cell_;                                         ///< steps
  std::unordered_map<GridPoint, std::uint32_t, Hash> cells_;  ///< last point in the cell
  std::vector<std::uint32_t> next_;                           ///< point before it in its cell
};

/// Numbers the corners of one geometry, each once.
class CornerNumbers {
 public:
  CornerNumbers(Boundary& boundary, std::span<const GridPoint> points, double tolerance_m)
      : snapper_(boundary.points, tolerance_m), points_(points), number_(points.size(), kNew) {}

  Ring operator()(const Ring& ring) {
    Ring corners;
    corners.reserve(ring.size());
    for (const std::uint32_t corner : ring) {
      if (number_[corner] == kNew) number_[corner] = snapper_.number(points_[corner]);
      corners.push_back(number_[corner]);
    }
    return corners;
  }

 private:
  static constexpr std::uint32_t kNew = ~0u;
  Snapper snapper_;
  std::span<const GridPoint> points_;
  std::vector<std::uint32_t> number_;
};

}  // namespace

std::string Boundary::label(const TestedPolygon& polygon) const {
  if (polygon.id.empty()) return fmt::format("{}polygon {}", name, polygon.number);
  return fmt::format("{}{}", name, polygon.id);
}

Boundary make_boundary(const Building& building, const Geometry& geometry,
                       std::span<const GridPoint> points, std::span<const std::uint32_t> polygons,
                       double snap_tolerance_m) {
  Boundary boundary;
  CornerNumbers corners(boundary, points, snap_tolerance_m);
  for (const std::uint32_t number : polygons) {
    const Polygon& polygon = geometry.polygons[number];
    TestedPolygon tested;
    tested.number = number;
    tested.id = polygon.gml_id;
    if (tested.id.empty() && polygon.surface >= 0)
      tested.id = building.surfaces[static_cast<std::size_t>(polygon.surface)].gml_id;
    for (const Ring& ring : polygon.rings) {
      Ring snapped = corners(ring);
      if (geometry.closed_rings) {
        if (snapped.size() > 1 && snapped.front() == snapped.back())
          snapped.pop_back();
        else if (tested.open_ring < 0)
          tested.open_ring = static_cast<std::int32_t>(tested.rings.size());
      }
      tested.rings.push_back(std::move(snapped));
    }
    boundary.polygons.push_back(std::move(tested));
  }
  return boundary;
}

Boundary make_boundary(const Shell& shell, std::span<const std::uint32_t> faces,
                       double snap_tolerance_m) {
  Boundary boundary;
  CornerNumbers corners(boundary, shell.points, snap_tolerance_m);
  for (const std::uint32_t number : faces) {
    const Face& face = shell.faces[number];
    TestedPolygon tested;
    tested.number = number;
    tested.id = shell.surface_ids[face.source];
    for (const Ring& ring : face.rings) tested.rings.push_back(corners(ring));
    boundary.polygons.push_back(std::move(tested));
  }
  return boundary;
}

}  // namespace citymesh
