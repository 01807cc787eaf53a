#include <algorithm>
#include <cerrno>
#include <map>
#include <mutex>
#include <set>
#include <system_error>

#include "core/source/build.h"
#include "core/source/plan.h"
#include "core/source/source.h"

namespace citymesh {
namespace {

namespace fs = std::filesystem;
using namespace source;

Error path_error(const fs::path& path, const std::error_code& error) {
  const auto code =
      error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory
          ? ErrorCode::NotFound
      : error == std::errc::permission_denied ? ErrorCode::PermissionDenied
                                              : ErrorCode::FailedPrecondition;
  return fail(code, "input '" + path.string() + "' cannot be read: " + error.message());
}

struct InputFile {
  fs::path path{};
  bool from_folder = false;  ///< found, not named: what is no city model is passed over
};

Result<std::vector<InputFile>> list_files(const std::vector<fs::path>& paths) {
  std::vector<InputFile> files;
  for (const fs::path& path : paths) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error) return path_error(path, error);
    if (!fs::is_directory(status)) {
      files.push_back({path});
      continue;
    }
    std::vector<fs::path> found;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end;
         entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_regular_file(ignored) && entry->path().filename().string().front() != '.')
        found.push_back(entry->path());
    }
    if (error) return path_error(path, error);
    std::sort(found.begin(), found.end());
    for (fs::path& file : found) files.push_back({std::move(file), true});
  }
  return files;
}

/// Tells whether a file is still the one that was scanned.
struct FileStamp {
  fs::file_time_type time{};
  std::uintmax_t size = 0;
  bool operator==(const FileStamp&) const = default;

  static FileStamp of(const fs::path& path) {
    std::error_code error;
    FileStamp stamp;
    stamp.time = fs::last_write_time(path, error);
    stamp.size = fs::file_size(path, error);
    return stamp;
  }
};

class FileSource final : public CitySource {
 public:
  FileSource(std::vector<fs::path> paths, FileSourceOptions options)
      : paths_(std::move(paths)), options_(std::move(options)) {}

  Result<Selection> select(const BuildingQuery& query, const RunContext& context) override {
    auto plan = make(query, context);
    if (!plan) return plan.error();
    return std::move(plan->selection);
  }

  Result<void> read(const BuildingQuery& query, const Selection& selection,
                    const BuildingSink& sink, const RunContext& context) override {
    auto plan = make(query, context);
    if (!plan) return plan.error();
    if (plan->selection.object_ids != selection.object_ids ||
        plan->selection.crs != selection.crs || plan->selection.origin != selection.origin)
      return fail(ErrorCode::FailedPrecondition,
                  "the input changed since the buildings were selected: select them again");
    for (const Plan::File& file : plan->files)
      if (auto done = read_file(file, query, selection, sink, context); !done) return done;
    return {};
  }

 private:
  Result<std::shared_ptr<const FileScan>> scan(const fs::path& path, bool with_footprints,
                                               const RunContext& context) {
    const FileStamp stamp = FileStamp::of(path);
    {
      const std::lock_guard lock(mutex_);
      const auto known = scans_.find(path);
      if (known != scans_.end() && known->second.first == stamp &&
          (known->second.second->has_footprints || !with_footprints))
        return known->second.second;
    }
    auto scanned = scan_file(path, options_.limits, with_footprints, context.stop);
    if (!scanned) return scanned.error();
    auto shared = std::make_shared<const FileScan>(std::move(*scanned));
    const std::lock_guard lock(mutex_);
    scans_[path] = {stamp, shared};
    return std::shared_ptr<const FileScan>(shared);
  }

  Result<Plan> make(const BuildingQuery& query, const RunContext& context) {
    const auto files = list_files(paths_);
    if (!files) return files.error();
    std::vector<std::shared_ptr<const FileScan>> scans;
    std::vector<std::string> passed_over;
    for (const InputFile& file : *files) {
      auto scanned = scan(file.path, query.bbox.has_value(), context);
      if (!scanned) return scanned.error();
      if (file.from_folder && (*scanned)->facts.not_a_city_model)
        passed_over.push_back(file.path.filename().string());
      else
        scans.push_back(std::move(*scanned));
    }
    auto plan = make_plan(scans, query, options_.assume_crs);
    if (plan)
      for (const std::string& name : passed_over)
        plan->selection.warnings.push_back(name + " is no city model, passed over");
    return plan;
  }

  Result<void> read_file(const Plan::File& file, const BuildingQuery& query,
                         const Selection& selection, const BuildingSink& sink,
                         const RunContext& context) {
    if (std::find(file.selected.begin(), file.selected.end(), true) == file.selected.end())
      return {};
    const FileScan& scan = *file.scan;
    std::vector<SrsPlacement> placements;
    for (const SrsUse& use : file.srs) {
      SrsPlacement& placement = placements.emplace_back();
      placement.swap_axes = use.swap_axes;
      placement.problem = use.problem;
      if (!use.problem.empty()) continue;
      auto transformer = Transformer::create(source_crs(use, query), selection.crs);
      if (transformer)
        placement.transformer = std::move(*transformer);
      else
        placement.problem = transformer.error().message;
    }

    BuildingMaker maker(std::move(placements), selection.origin);
    const DocumentOptions options{.limits = options_.limits,
                                  .stem = file_stem(scan.path),
                                  .stop = context.stop,
                                  .shared = scan.shared.get()};
    DocumentFacts facts;
    facts.srs_names = scan.facts.srs_names;
    const auto changed = [&] {
      return fail(ErrorCode::FailedPrecondition,
                  "'" + scan.path.string() + "' changed while it was read");
    };
    std::size_t next = 0;
    auto done = read_document(scan.path, *scan.format, options, facts,
                              [&](Feature& feature) -> Result<void> {
                                const std::size_t b = next++;
                                if (b >= scan.buildings.size() ||
                                    feature.objects.front().gml_id != scan.buildings[b].gml_id ||
                                    facts.srs_names.size() != scan.facts.srs_names.size())
                                  return changed();
                                if (!file.selected[b]) return {};
                                return sink(maker.make(feature));
                              });
    if (!done) return done;
    if (next != scan.buildings.size()) return changed();
    return {};
  }

  std::vector<fs::path> paths_;
  FileSourceOptions options_;
  std::mutex mutex_{};
  std::map<fs::path, std::pair<FileStamp, std::shared_ptr<const FileScan>>> scans_{};
};

}  // namespace

Result<std::unique_ptr<CitySource>> open_files(std::vector<std::filesystem::path> paths,
                                               FileSourceOptions options) {
  if (paths.empty())
    return fail(ErrorCode::InvalidArgument, "no input: name at least one file or folder");
  if (const auto files = list_files(paths); !files) return files.error();
  return std::unique_ptr<CitySource>(
      std::make_unique<FileSource>(std::move(paths), std::move(options)));
}

}  // namespace citymesh
