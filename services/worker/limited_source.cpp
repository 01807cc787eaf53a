#include "services/worker/limited_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace citymesh {
namespace {

constexpr double kDegree_km = 111.2;  // of a great circle
constexpr double kKm2_m2 = 1e6;

/// Near enough for a limit; nothing when the CRS is not known, which the source then says.
std::optional<double> area_km2(const RequestBox& box) {
  const auto facts = describe_crs(box.crs);
  if (!facts) return std::nullopt;
  const double width = std::abs(box.max_x - box.min_x);
  const double height = std::abs(box.max_y - box.min_y);
  if (!facts->geographic)
    return width * height * facts->horizontal_unit_m * facts->horizontal_unit_m / kKm2_m2;
  const double middle = (box.min_y + box.max_y) / 2 * std::numbers::pi / 180;
  return width * height * kDegree_km * kDegree_km * std::max(0.0, std::cos(middle));
}

std::uint64_t points_of(const Building& building) {
  std::uint64_t points = 0;
  for (const auto& geometry : building.geometries) points += geometry.points.size();
  for (const auto& part : building.parts) points += points_of(part);
  for (const auto& installation : building.installations) points += points_of(installation);
  return points;
}

class LimitedSource final : public CitySource {
 public:
  LimitedSource(std::unique_ptr<CitySource> source, const JobLimits& limits)
      : source_(std::move(source)), limits_(limits) {}

  Result<Selection> select(const BuildingQuery& query, const RunContext& context) override {
    auto selection = source_->select(query, context);
    if (selection && limits_.buildings > 0 && selection->buildings > limits_.buildings)
      return fail(ErrorCode::ResourceExhausted,
                  fmt::format("{} buildings are selected, at most {} may be in one job; choose a "
                              "smaller `bbox`, or `object_ids`",
                              selection->buildings, limits_.buildings));
    return selection;
  }

  Result<void> read(const BuildingQuery& query, const Selection& selection,
                    const BuildingSink& sink, const RunContext& context) override {
    if (limits_.points == 0) return source_->read(query, selection, sink, context);
    std::uint64_t points = 0;
    return source_->read(
        query, selection,
        [&](Building&& building) -> Result<void> {
          points += points_of(building);
          if (points > limits_.points)
            return fail(ErrorCode::ResourceExhausted,
                        fmt::format("the buildings up to '{}' have {} points, at most {} may be in "
                                    "one job; choose a smaller `bbox`",
                                    building.gml_id, points, limits_.points));
          return sink(std::move(building));
        },
        context);
  }

 private:
  std::unique_ptr<CitySource> source_;
  const JobLimits limits_;
};

}  // namespace

Result<void> check_area(const BuildingQuery& query, double max_km2) {
  if (!query.bbox) return {};
  if (const auto area = area_km2(*query.bbox); area && *area > max_km2)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("input `bbox` covers {:.4g} km², at most {:.4g} km² may be in one job",
                            *area, max_km2));
  return {};
}

std::unique_ptr<CitySource> limited(std::unique_ptr<CitySource> source, const JobLimits& limits) {
  return std::make_unique<LimitedSource>(std::move(source), limits);
}

}  // namespace citymesh
