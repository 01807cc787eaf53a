#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/gates/gates.h"

namespace citymesh {

/// Collects the polygons of a body as triangles: each polygon is cut exactly as meshing cuts it.
/// Equal coordinates become one point.
class PolygonBody {
 public:
  explicit PolygonBody(std::string name) { body_.name = std::move(name); }

  const std::string& name() const { return body_.name; }
  std::size_t triangles() const { return body_.triangles.size(); }

  /// The index of a point in metres from the origin. Errors: DataLoss for what lies beyond the
  /// grid.
  Result<std::uint32_t> point(const Point3& p);

  /// Errors: DataLoss for rings that bound no area.
  Result<void> add(std::span<const std::vector<std::uint32_t>> rings, std::string_view patch);

  ParsedBody take() { return std::move(body_); }

 private:
  struct Hash {
    std::size_t operator()(const GridPoint& p) const;
  };

  ParsedBody body_{};
  std::vector<GridPoint> grid_{};
  std::unordered_map<GridPoint, std::uint32_t, Hash> known_{};
  std::size_t polygons_ = 0;
};

}  // namespace citymesh
