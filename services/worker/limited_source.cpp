#include "services/worker/limited_source.h"

#include <fmt/format.h>

#include <utility>

namespace citymesh {
namespace {

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

Result<void> check_area(const Inputs& inputs, double max_km2) {
  if (inputs.area_km2 <= max_km2) return {};
  return fail(
      ErrorCode::InvalidArgument,
      fmt::format("input `{}` covers {:.4g} km², at most {:.4g} km² may be in one job",
                  inputs.query.bbox && !inputs.query.bbox->rings.empty() ? "polygon" : "bbox",
                  inputs.area_km2, max_km2));
}

std::unique_ptr<CitySource> limited(std::unique_ptr<CitySource> source, const JobLimits& limits) {
  return std::make_unique<LimitedSource>(std::move(source), limits);
}

}  // namespace citymesh
