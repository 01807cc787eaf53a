#include "tests/support/defects/defects.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace citymesh::testing {
namespace {

constexpr double kMinGap_m = 0.1;  ///< between a wall across the house and the nearest corner

using Ring = std::vector<Point3>;

std::vector<std::size_t> faces_where(const House& house,
                                     const std::function<bool(const HouseFace&)>& holds) {
  std::vector<std::size_t> found;
  for (std::size_t f = 0; f < house.faces.size(); ++f)
    if (holds(house.faces[f])) found.push_back(f);
  return found;
}

bool is_wall(const HouseFace& face) { return face.type == SurfaceType::WallSurface; }
bool is_ground(const HouseFace& face) { return face.type == SurfaceType::GroundSurface; }
bool is_roof(const HouseFace& face) { return face.type == SurfaceType::RoofSurface; }

void turn(HouseFace& face) {
  for (Ring& ring : face.rings) std::reverse(ring.begin(), ring.end());
}

Point3 between(const Point3& a, const Point3& b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

double distance_m(const Point3& a, const Point3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

double bend_roof(House& house, Random& random) {
  auto roofs =
      faces_where(house, [](const HouseFace& f) { return is_roof(f) && f.rings[0].size() > 3; });
  if (roofs.empty()) return 0;
  const Point3 corner = random.one_of(house.faces[random.one_of(roofs)].rings[0]);
  const double shift_m = (random.coin() ? 1 : -1) * random.between(0.02, 0.05);
  double swept_m3 = 0;
  for (HouseFace& face : house.faces) {
    bool has_corner = false;
    for (Ring& ring : face.rings)
      for (Point3& p : ring)
        if (p == corner) {
          p.z += shift_m;
          has_corner = true;
        }
    if (has_corner && is_roof(face)) swept_m3 += std::abs(area_vector(face).z) * std::abs(shift_m);
  }
  return swept_m3;
}

/// Gives the faces that a wall ends on its corners.
void insert_into_edges(House& house, const HouseFace& wall) {
  for (const Point3& p : wall.rings[0])
    for (HouseFace& face : house.faces)
      for (Ring& ring : face.rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Point3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
          if (p == a || p == b || distance_m(a, p) + distance_m(p, b) > distance_m(a, b) + 1e-7)
            continue;
          ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1, p);
          ++i;
        }
}

void add_interior_wall(House& house, Random& random) {
  double low = std::numeric_limits<double>::max(), high = -low;
  std::vector<double> taken;
  for (const HouseFace& face : house.faces)
    for (const Ring& ring : face.rings)
      for (const Point3& p : ring) {
        low = std::min(low, p.x), high = std::max(high, p.x);
        taken.push_back(p.x);
      }
  for (int attempt = 0; attempt < 20; ++attempt) {
    const double x = std::round(random.between(low, high) * 1e3) / 1e3;
    if (std::any_of(taken.begin(), taken.end(),
                    [&](double t) { return std::abs(t - x) < kMinGap_m; }))
      continue;
    const bool shares_corners = random.coin();
    for (HouseFace& wall : cross_section(house, x)) {
      if (shares_corners) insert_into_edges(house, wall);
      house.faces.push_back(std::move(wall));
    }
    return;
  }
}

void drop_one(House& house, const std::vector<std::size_t>& candidates, Random& random) {
  if (!candidates.empty())
    house.faces.erase(house.faces.begin() + static_cast<std::ptrdiff_t>(random.one_of(candidates)));
}

void duplicate(House& house, Random& random) {
  HouseFace copy = random.one_of(house.faces);
  if (random.coin()) turn(copy);
  if (random.coin())
    std::rotate(copy.rings[0].begin(), copy.rings[0].begin() + 1, copy.rings[0].end());
  house.faces.push_back(std::move(copy));
}

void tie_bow(House& house, Random& random) {
  const auto candidates =
      faces_where(house, [](const HouseFace& f) { return f.rings[0].size() > 3; });
  if (candidates.empty()) return;
  Ring& ring = house.faces[random.one_of(candidates)].rings[0];
  const std::size_t i = random.below(ring.size());
  std::swap(ring[i], ring[(i + 1) % ring.size()]);
}

void split_edge(House& house, Random& random) {
  Ring& ring = random.one_of(random.one_of(house.faces).rings);
  const std::size_t i = random.below(ring.size());
  const Point3 p = between(ring[i], ring[(i + 1) % ring.size()], random.between(0.2, 0.8));
  ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1, p);
}

void move_corner(House& house, Random& random) {
  Point3& corner = random.one_of(random.one_of(random.one_of(house.faces).rings));
  const double by_m = random.between(0.002, 0.005);
  const double azimuth = random.between(0, 2 * std::numbers::pi), z = random.between(-1, 1),
               r = std::sqrt(1 - z * z);
  corner.x += by_m * r * std::cos(azimuth);
  corner.y += by_m * r * std::sin(azimuth);
  corner.z += by_m * z;
}

void repeat_corner(House& house, Random& random) {
  Ring& ring = random.one_of(random.one_of(house.faces).rings);
  const auto at = static_cast<std::ptrdiff_t>(random.below(ring.size()));
  ring.insert(ring.begin() + at, ring[static_cast<std::size_t>(at)]);
}

}  // namespace

std::string_view to_string(Defect defect) {
  switch (defect) {
    case Defect::NonPlanarRoof:
      return "non_planar_roof";
    case Defect::InteriorWall:
      return "interior_wall";
    case Defect::MissingWall:
      return "missing_wall";
    case Defect::MissingGround:
      return "missing_ground";
    case Defect::FlippedFace:
      return "flipped_face";
    case Defect::DuplicateFace:
      return "duplicate_face";
    case Defect::BowTie:
      return "bow_tie";
    case Defect::TJunction:
      return "t_junction";
    case Defect::UnsnappedVertex:
      return "unsnapped_vertex";
    case Defect::RepeatedPoint:
      return "repeated_point";
  }
  return "";
}

double inject(House& house, Defect defect, Random& random) {
  switch (defect) {
    case Defect::NonPlanarRoof:
      return bend_roof(house, random);
    case Defect::InteriorWall:
      add_interior_wall(house, random);
      break;
    case Defect::MissingWall:
      drop_one(house, faces_where(house, is_wall), random);
      break;
    case Defect::MissingGround:
      std::erase_if(house.faces, is_ground);
      break;
    case Defect::FlippedFace:
      turn(random.one_of(house.faces));
      break;
    case Defect::DuplicateFace:
      duplicate(house, random);
      break;
    case Defect::BowTie:
      tie_bow(house, random);
      break;
    case Defect::TJunction:
      split_edge(house, random);
      break;
    case Defect::UnsnappedVertex:
      move_corner(house, random);
      break;
    case Defect::RepeatedPoint:
      repeat_corner(house, random);
      break;
  }
  return 0;
}

}  // namespace citymesh::testing
