#include "tests/support/defects/city.h"

#include <cmath>
#include <numbers>

#include "tests/support/defects/shapes.h"

namespace citymesh::testing {
namespace {

constexpr double kPlot_m = 80;  ///< side of the square that holds any house

std::string name_of(const DefectiveHouse& house, std::size_t number) {
  std::string name(house.shape);
  for (const Defect defect : house.defects) name.append(".").append(to_string(defect));
  return name + "." + std::to_string(number);
}

}  // namespace

DefectiveHouse make_house(std::size_t shape, const std::vector<Defect>& defects, std::uint64_t seed,
                          double x_m, double y_m) {
  Random random(seed);
  DefectiveHouse made;
  made.shape = house_shapes()[shape].name;
  made.defects = defects;
  House house = house_shapes()[shape].build(random);
  made.volume_m3 = volume_m3(house);
  for (const Defect defect : defects) made.undefined_m3 += inject(house, defect, random);

  // One house in three stands straight.
  const double angle = random.below(3) == 0 ? 0 : random.between(0, 2 * std::numbers::pi);
  const double c = std::cos(angle), s = std::sin(angle), ground_m = random.between(30, 40);
  const double steps_per_metre = random.coin() ? 1e3 : 1e4;
  const auto rounded = [&](double v) { return std::round(v * steps_per_metre) / steps_per_metre; };

  Building& building = made.building;
  building.geometries.emplace_back();
  Geometry& geometry = building.geometries.back();
  geometry.lod = {2, -1};
  geometry.type = random.coin() ? GeometryType::Solid : GeometryType::MultiSurface;
  for (const HouseFace& face : house.faces) {
    Polygon polygon;
    polygon.surface = static_cast<std::int32_t>(building.surfaces.size());
    building.surfaces.push_back({face.type, {}});
    for (const auto& points : face.rings) {
      Ring ring;
      for (const Point3& p : points) {
        ring.push_back(static_cast<std::uint32_t>(geometry.points.size()));
        geometry.points.push_back({rounded(x_m + kPlot_m / 2 + c * p.x - s * p.y),
                                   rounded(y_m + kPlot_m / 2 + s * p.x + c * p.y),
                                   rounded(ground_m + p.z)});
      }
      polygon.rings.push_back(std::move(ring));
    }
    geometry.polygons.push_back(std::move(polygon));
  }
  if (geometry.type == GeometryType::Solid) {
    Solid solid;
    for (std::uint32_t i = 0; i < geometry.polygons.size(); ++i) solid.exterior.push_back(i);
    geometry.solids.push_back(std::move(solid));
  }
  return made;
}

std::vector<DefectiveHouse> make_city(const CityPlan& plan) {
  std::vector<std::vector<Defect>> kinds;
  for (std::size_t i = 0; i < plan.sound; ++i) kinds.emplace_back();
  for (const Defect defect : kDefects)
    for (std::size_t i = 0; i < plan.singles; ++i) kinds.push_back({defect});
  for (std::size_t i = 0; i < kDefects.size(); ++i)
    for (std::size_t j = i + 1; j < kDefects.size(); ++j)
      for (std::size_t k = 0; k < plan.pairs; ++k) kinds.push_back({kDefects[i], kDefects[j]});

  const std::size_t count = kinds.size() * house_shapes().size();
  const auto row = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::vector<DefectiveHouse> city;
  city.reserve(count);
  Random seeds(plan.seed);
  for (std::size_t shape = 0; shape < house_shapes().size(); ++shape)
    for (const std::vector<Defect>& defects : kinds) {
      const std::size_t number = city.size();
      city.push_back(make_house(shape, defects, seeds.below(~std::size_t{0}),
                                kPlot_m * static_cast<double>(number % row),
                                kPlot_m * static_cast<double>(number / row)));
      Building& building = city.back().building;
      building.gml_id = name_of(city.back(), number);
      for (std::size_t s = 0; s < building.surfaces.size(); ++s)
        building.surfaces[s].gml_id = building.gml_id + ".s" + std::to_string(s);
    }
  return city;
}

}  // namespace citymesh::testing
