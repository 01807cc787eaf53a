#include "core/validate/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/citymodel/edges.h"
#include "core/geometry/place.h"
#include "core/geometry/triangulation.h"

namespace citymesh {
namespace {

/// Largest distance of a corner to the plane through the corners' mean along Newell's normal.
double distance_to_plane_m(const Shell& shell, const Face& face) {
  const Point3 n = ring_normal(shell.points, face.rings[0]);
  const double length = std::hypot(n.x, n.y, n.z);
  if (length == 0) return 0;
  Point3 mean{};
  double count = 0;
  for (const Ring& ring : face.rings)
    for (const std::uint32_t corner : ring) {
      const Point3 p = to_metres(shell.points[corner]);
      mean = {mean.x + p.x, mean.y + p.y, mean.z + p.z};
      ++count;
    }
  mean = {mean.x / count, mean.y / count, mean.z / count};
  double largest = 0;
  for (const Ring& ring : face.rings)
    for (const std::uint32_t corner : ring) {
      const Point3 p = to_metres(shell.points[corner]);
      largest = std::max(
          largest,
          std::abs(n.x * (p.x - mean.x) + n.y * (p.y - mean.y) + n.z * (p.z - mean.z)) / length);
    }
  return largest;
}

void check_face(const Shell& shell, const Face& face, const ValidateOptions& options,
                std::vector<Issue>& issues) {
  const std::string& id = shell.surface_ids[face.source];
  bool rings_usable = true;
  for (std::size_t r = 0; r < face.rings.size(); ++r) {
    const Ring& ring = face.rings[r];
    const std::string where = face.rings.size() > 1 ? fmt::format("{} ring {}", id, r) : id;
    if (std::set<std::uint32_t>(ring.begin(), ring.end()).size() < 3) {
      issues.push_back({101, where, static_cast<double>(ring.size())});
      rings_usable = false;
      continue;
    }
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (ring[i] == ring[(i + 1) % ring.size()]) {
        issues.push_back({102, where + " " + place_text(shell.points[ring[i]]), 0});
        rings_usable = false;
        break;
      }
  }
  if (!rings_usable) return;
  if (const double distance = distance_to_plane_m(shell, face);
      distance > options.planarity_tolerance_m)
    issues.push_back({203, id, distance});
  if (triangulate(shell.points, face.rings)) return;
  const std::size_t before = issues.size();
  for (std::size_t r = 0; r < face.rings.size(); ++r)
    if (!triangulate(shell.points, std::span(face.rings).subspan(r, 1)))
      issues.push_back({104, face.rings.size() > 1 ? fmt::format("{} ring {}", id, r) : id, 0});
  if (issues.size() == before) issues.push_back({201, id, 0});
}

}  // namespace

std::vector<Issue> validate(const Shell& shell, const ValidateOptions& options) {
  std::vector<Issue> issues;
  for (const Face& face : shell.faces) check_face(shell, face, options, issues);
  if (shell.faces.size() < 4) issues.push_back({301, "", static_cast<double>(shell.faces.size())});

  struct Defect {
    int code;
    std::string where{};
    double count = 0;
  };
  Defect defects[]{{302}, {303}, {307}};
  for (const auto& [edge, uses] : edge_uses(shell)) {
    if (edge.first == edge.second) continue;
    Defect* defect = uses.size() == 1                     ? &defects[0]
                     : uses.size() > 2                    ? &defects[1]
                     : uses[0].forward == uses[1].forward ? &defects[2]
                                                          : nullptr;
    if (!defect) continue;
    if (defect->count++ == 0)
      defect->where =
          place_text(shell.points[edge.first]) + "–" + place_text(shell.points[edge.second]);
  }
  for (const Defect& defect : defects)
    if (defect.count > 0) issues.push_back({defect.code, defect.where, defect.count});
  return issues;
}

}  // namespace citymesh
