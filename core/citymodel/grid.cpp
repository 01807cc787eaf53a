#include "core/citymodel/grid.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "core/geometry/measure.h"

namespace citymesh {

std::optional<GridPoint> to_grid(const Point3& p) {
  constexpr double kLimit_m = static_cast<double>(kGridLimit) * kGridStep_m;
  if (!(std::abs(p.x) < kLimit_m && std::abs(p.y) < kLimit_m && std::abs(p.z) < kLimit_m))
    return {};
  return GridPoint{std::llround(p.x * kGridStepsPerMetre), std::llround(p.y * kGridStepsPerMetre),
                   std::llround(p.z * kGridStepsPerMetre)};
}

std::variant<Gridded, Issue> grid(const Building& building, const Geometry& geometry) {
  Gridded result;
  Shell& shell = result.shell;

  std::vector<std::uint32_t> index_of(geometry.points.size());
  std::map<GridPoint, std::uint32_t> known;
  for (std::size_t i = 0; i < geometry.points.size(); ++i) {
    const Point3& p = geometry.points[i];
    const std::optional<GridPoint> g = to_grid(p);
    if (!g)
      return Issue{issue_code::kCoordinateOutOfRange, fmt::format("({} {} {})", p.x, p.y, p.z),
                   p.x};
    const Point3 back = to_metres(*g);
    result.max_displacement_m =
        std::max(result.max_displacement_m, std::hypot(back.x - p.x, back.y - p.y, back.z - p.z));
    const auto [at, added] = known.emplace(*g, static_cast<std::uint32_t>(shell.points.size()));
    if (added) shell.points.push_back(*g);
    index_of[i] = at->second;
  }

  shell.surface_ids.emplace_back();
  std::map<std::string, std::uint32_t> source_of;
  const auto add_face = [&](std::uint32_t polygon_index, bool cavity) {
    const Polygon& polygon = geometry.polygons[polygon_index];
    Face face;
    face.cavity = cavity;
    const Surface* surface = polygon.surface >= 0
                                 ? &building.surfaces[static_cast<std::size_t>(polygon.surface)]
                                 : nullptr;
    if (surface) {
      face.type = surface->type;
      face.made_by = surface->made_by;
    }
    const std::string& id = surface && !surface->gml_id.empty() ? surface->gml_id : polygon.gml_id;
    if (!id.empty()) {
      const auto [at, added] =
          source_of.emplace(id, static_cast<std::uint32_t>(shell.surface_ids.size()));
      if (added) shell.surface_ids.push_back(id);
      face.source = at->second;
    }
    for (const Ring& ring : polygon.rings) {
      Ring gridded;
      gridded.reserve(ring.size());
      for (const std::uint32_t corner : ring) gridded.push_back(index_of[corner]);
      if (gridded.size() > 1 && gridded.front() == gridded.back()) gridded.pop_back();
      face.rings.push_back(std::move(gridded));
    }
    if (!face.rings.empty()) shell.faces.push_back(std::move(face));
  };

  if (geometry.solids.empty()) {
    for (std::uint32_t i = 0; i < geometry.polygons.size(); ++i) add_face(i, false);
  } else {
    for (const Solid& solid : geometry.solids) {
      for (const std::uint32_t polygon : solid.exterior) add_face(polygon, false);
      for (const auto& interior : solid.interiors)
        for (const std::uint32_t polygon : interior) add_face(polygon, true);
    }
  }
  if (shell.faces.empty()) return Issue{902, building.gml_id, 0};
  return result;
}

}  // namespace citymesh
