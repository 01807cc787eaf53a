#include "tests/support/defects/house.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace citymesh::testing {
namespace {

Point3 cross(const Point3& a, const Point3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Where the plane x = x_m cuts an edge; the same for both faces that have it.
Point3 cut(Point3 a, Point3 b, double x_m) {
  if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::swap(a, b);
  const double t = (x_m - a.x) / (b.x - a.x);
  const auto micrometres = [](double v) { return std::round(v * 1e6) / 1e6; };
  return {x_m, micrometres(a.y + t * (b.y - a.y)), micrometres(a.z + t * (b.z - a.z))};
}

}  // namespace

Point3 area_vector(const HouseFace& face) {
  Point3 sum{};
  for (const auto& ring : face.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point3 c = cross(ring[i], ring[(i + 1) % ring.size()]);
      sum = {sum.x + c.x / 2, sum.y + c.y / 2, sum.z + c.z / 2};
    }
  return sum;
}

double volume_m3(const House& house) {
  double volume = 0;
  for (const HouseFace& face : house.faces) {
    const Point3 a = area_vector(face);
    const Point3& p = face.rings[0][0];
    volume += (a.x * p.x + a.y * p.y + a.z * p.z) / 3;
  }
  return volume;
}

std::vector<HouseFace> cross_section(const House& house, double x_m) {
  using Place = std::pair<double, double>;  // y, z
  std::map<Place, std::vector<Place>> neighbours;
  for (const HouseFace& face : house.faces) {
    std::vector<Place> cuts;
    for (const auto& ring : face.rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
        if ((a.x < x_m) == (b.x < x_m)) continue;
        const Point3 p = cut(a, b, x_m);
        cuts.emplace_back(p.y, p.z);
      }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) {
      if (cuts[i] == cuts[i + 1]) continue;
      neighbours[cuts[i]].push_back(cuts[i + 1]);
      neighbours[cuts[i + 1]].push_back(cuts[i]);
    }
  }
  std::vector<HouseFace> walls;
  while (!neighbours.empty()) {
    std::vector<Point3> ring;
    Place at = neighbours.begin()->first;
    while (true) {
      const auto next = neighbours.find(at);
      if (next == neighbours.end()) break;
      ring.push_back({x_m, at.first, at.second});
      const std::vector<Place> links = std::move(next->second);
      neighbours.erase(next);
      const auto open = std::find_if(links.begin(), links.end(),
                                     [&](const Place& p) { return neighbours.contains(p); });
      if (open == links.end()) break;
      at = *open;
    }
    if (ring.size() > 2) walls.push_back({SurfaceType::WallSurface, {std::move(ring)}});
  }
  return walls;
}

}  // namespace citymesh::testing
