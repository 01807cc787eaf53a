#include "core/source/catalogue.h"

#include <sys/stat.h>

#include <utility>

#include "core/source/pieces.h"
#include "core/source/plan.h"

namespace citymesh::source {
namespace {

class CatalogueSource final : public CitySource {
 public:
  CatalogueSource(std::shared_ptr<Catalogue> catalogue, FileSourceOptions options)
      : catalogue_(std::move(catalogue)), options_(std::move(options)) {}

  Result<Selection> select(const BuildingQuery& query, const RunContext& context) override {
    auto plan = make_plan(*catalogue_, query, options_.assume_crs, context);
    if (!plan) return plan.error();
    Selection selection = std::exchange(plan->selection, {});
    selection.details = std::make_shared<const Plan>(std::move(*plan));
    return selection;
  }

  Result<void> read(const BuildingQuery& query, const Selection& selection,
                    const BuildingSink& sink, const RunContext& context) override {
    const auto plan = std::static_pointer_cast<const Plan>(selection.details);
    if (!plan)
      return fail(ErrorCode::FailedPrecondition,
                  "the selection was not made by this source: select the buildings again");
    for (const Plan::File& file : plan->files) {
      const auto new_maker = [&] {
        return BuildingMaker(placements(file, query, selection.crs), selection.origin);
      };
      if (auto done = read_buildings(*file.record, file.selected, new_maker, options_.limits, sink,
                                     context);
          !done)
        return done;
    }
    return {};
  }

 private:
  static std::vector<SrsPlacement> placements(const Plan::File& file, const BuildingQuery& query,
                                              const Crs& working) {
    std::vector<SrsPlacement> placements;
    for (const SrsUse& use : file.srs) {
      SrsPlacement& placement = placements.emplace_back();
      placement.swap_axes = use.swap_axes;
      placement.problem = use.problem;
      if (!use.problem.empty()) continue;
      auto transformer = Transformer::create(source_crs(use, query), working);
      if (transformer)
        placement.transformer = std::move(*transformer);
      else
        placement.problem = transformer.error().message;
    }
    return placements;
  }

  std::shared_ptr<Catalogue> catalogue_;
  FileSourceOptions options_;
};

}  // namespace

std::optional<FileStamp> FileStamp::of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileStamp{
      static_cast<std::int64_t>(status.st_mtim.tv_sec) * 1'000'000'000 + status.st_mtim.tv_nsec,
      static_cast<std::uint64_t>(status.st_size)};
}

std::unique_ptr<CitySource> open_catalogue(std::shared_ptr<Catalogue> catalogue,
                                           FileSourceOptions options) {
  return std::make_unique<CatalogueSource>(std::move(catalogue), std::move(options));
}

}  // namespace citymesh::source
