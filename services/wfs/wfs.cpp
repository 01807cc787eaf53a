#include "services/wfs/wfs.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "core/source/catalogue.h"
#include "core/source/temporary_folder.h"
#include "services/wfs/download.h"
#include "services/wfs/server.h"

namespace citymesh {
namespace {

using wfs::Pages;
using wfs::Server;

/// A selection of what has been downloaded, and its files.
struct Downloaded {
  source::TemporaryFolder folder{};
  std::unique_ptr<CitySource> files{};
  std::shared_ptr<const void> details{};  ///< of the selection that `files` made
};

class WfsSource final : public CitySource {
 public:
  WfsSource(std::shared_ptr<const Server> server, WfsUse use)
      : server_(std::move(server)), use_(use) {}

  Result<Selection> select(const BuildingQuery& query, const RunContext& context) override {
    // What is wrong with the query itself is said before anything is downloaded.
    if (auto checked = over(std::make_shared<Pages>())->select(query, context); !checked)
      return checked.error();
    if (use_ == WfsUse::Counting && can_be_counted(query)) {
      const auto counted = wfs::count(*server_, query, context);
      if (!counted) return counted.error();
      if (*counted) return selection_of(**counted, query, context);
    }
    auto folder = source::TemporaryFolder::make("to keep what a WFS answers");
    if (!folder) return folder.error();
    const auto content = wfs::download(*server_, query, folder->path(), context);
    if (!content) return content.error();

    BuildingQuery here = query;
    if (content->pages->buildings() == 0 && !here.crs.known()) {
      // No building says which CRS to work in.
      auto working = working_crs_for_nothing(query);
      if (!working) return working.error();
      here.crs = std::move(*working);
    }
    auto downloaded = std::make_shared<Downloaded>();
    downloaded->folder = std::move(*folder);
    downloaded->files = over(content->pages);
    auto selection = downloaded->files->select(here, context);
    if (!selection) return selection.error();
    downloaded->details = std::move(selection->details);
    selection->details = std::move(downloaded);
    selection->inputs = {summed_up(selection->inputs)};
    selection->warnings.insert(selection->warnings.end(), content->warnings.begin(),
                               content->warnings.end());
    return selection;
  }

  Result<void> read(const BuildingQuery& query, const Selection& selection,
                    const BuildingSink& sink, const RunContext& context) override {
    const auto downloaded = std::static_pointer_cast<const Downloaded>(selection.details);
    if (!downloaded)
      return fail(ErrorCode::FailedPrecondition,
                  "the selection was not made by this source: select the buildings again");
    Selection of_files = selection;
    of_files.details = downloaded->details;
    return downloaded->files->read(query, of_files, sink, context);
  }

 private:
  std::unique_ptr<CitySource> over(std::shared_ptr<Pages> pages) const {
    return source::open_catalogue(std::move(pages),
                                  {.limits = server_->options.limits, .assume_crs = server_->crs});
  }

  /// Whether the number of buildings, and where to work, can be told without any of them.
  bool can_be_counted(const BuildingQuery& query) const {
    if (!query.object_ids.empty()) return false;
    if (query.bbox || query.crs.known()) return true;
    const auto facts = describe_crs(server_->crs);
    return facts && !facts->geographic;
  }

  /// A selection of so many buildings of which nothing else is known.
  Result<Selection> selection_of(std::uint64_t buildings, const BuildingQuery& query,
                                 const RunContext& context) const {
    BuildingQuery here = query;
    if (!here.crs.known()) {
      auto working = working_crs_for_nothing(query);
      if (!working) return working.error();
      here.crs = std::move(*working);
    }
    auto selection = over(std::make_shared<Pages>())->select(here, context);
    if (!selection) return selection.error();
    selection->buildings = buildings;
    selection->expected_triangles.reset();
    selection->details.reset();
    if (query.bbox && (!query.bbox->rings.empty() || query.bbox->z_range_m ||
                       query.bbox_rule != BboxRule::Intersects))
      selection->warnings.push_back(
          fmt::format("WFS {}: the server counts all whose envelope meets the box, of which fewer "
                      "will be chosen",
                      server_->shown));
    selection->inputs = {{.file = server_->shown,
                          .format = "WFS " + server_->version,
                          .state = "read",
                          .crs = server_->crs.id,
                          .buildings = buildings}};
    return selection;
  }

  Result<Crs> working_crs_for_nothing(const BuildingQuery& query) const {
    Point3 centre{};
    if (query.bbox) {
      centre = {(query.bbox->min_x + query.bbox->max_x) / 2,
                (query.bbox->min_y + query.bbox->max_y) / 2, 0};
      if (query.bbox->crs.known()) {
        const auto transformer = Transformer::create(query.bbox->crs, server_->crs);
        if (!transformer) return transformer.error();
        if (auto moved = transformer->apply({&centre, 1}); !moved) return moved.error();
      }
    }
    return working_crs(server_->crs, centre);
  }

  /// One store, whatever number of answers it took.
  InputReport summed_up(const std::vector<InputReport>& pages) const {
    InputReport all{.file = server_->shown, .format = "WFS " + server_->version, .state = "read"};
    std::set<std::string> crs;
    for (const auto& page : pages) {
      all.buildings += page.buildings;
      if (!page.crs.empty()) crs.insert(page.crs);
    }
    for (const auto& name : crs) all.crs += (all.crs.empty() ? "" : ", ") + name;
    return all;
  }

  std::shared_ptr<const Server> server_;
  const WfsUse use_;
};

}  // namespace

Result<WfsFactory> open_wfs(const WfsOptions& options) {
  auto looked = wfs::look_at(options);
  if (!looked) return looked.error();
  return WfsFactory([server = std::make_shared<const Server>(std::move(*looked))](
                        WfsUse use) -> Result<std::unique_ptr<CitySource>> {
    return std::unique_ptr<CitySource>(std::make_unique<WfsSource>(server, use));
  });
}

std::string shown_wfs_url(const std::string& url) { return wfs::shown_url(url); }

}  // namespace citymesh
