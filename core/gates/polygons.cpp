#include "core/gates/polygons.h"

#include <cmath>

#include "core/gates/parse.h"
#include "core/geometry/triangulation.h"

namespace citymesh {

std::size_t PolygonBody::Hash::operator()(const GridPoint& p) const {
  std::uint64_t h = static_cast<std::uint64_t>(p.x) * 0x9E3779B97F4A7C15ull;
  h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(p.y)) * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(p.z)) * 0x94D049BB133111EBull;
  return static_cast<std::size_t>(h ^ (h >> 31));
}

Result<std::uint32_t> PolygonBody::point(const Point3& p) {
  const auto limit = static_cast<double>(kGridLimit) / kGridStepsPerMetre;
  if (!(std::abs(p.x) <= limit && std::abs(p.y) <= limit && std::abs(p.z) <= limit))
    return fail(ErrorCode::DataLoss, "body " + in_quotes(name()) + ": point (" +
                                         std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
                                         std::to_string(p.z) + ") lies beyond the grid");
  const GridPoint grid{std::llround(p.x * kGridStepsPerMetre),
                       std::llround(p.y * kGridStepsPerMetre),
                       std::llround(p.z * kGridStepsPerMetre)};
  const auto [entry, is_new] = known_.try_emplace(grid, static_cast<std::uint32_t>(grid_.size()));
  if (is_new) {
    grid_.push_back(grid);
    body_.points.push_back(p);
  }
  return entry->second;
}

Result<void> PolygonBody::add(std::span<const std::vector<std::uint32_t>> rings,
                              std::string_view patch) {
  const std::size_t number = polygons_++;
  const auto triangles = triangulate(grid_, rings);
  if (!triangles)
    return fail(ErrorCode::DataLoss, "body " + in_quotes(name()) + ": the rings of polygon " +
                                         std::to_string(number) + " bound no area");
  body_.triangles.insert(body_.triangles.end(), triangles->begin(), triangles->end());
  body_.patches.insert(body_.patches.end(), triangles->size(), std::string(patch));
  return {};
}

}  // namespace citymesh
