#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/source/listing.h"
#include "core/source/scan.h"
#include "core/source/source.h"
#include "core/source/temporary_folder.h"
#include "core/source/zip.h"

namespace citymesh {
namespace {

namespace fs = std::filesystem;
using namespace source;

/// What first passes found, kept in memory until a file changes.
class ScannedFiles final : public Catalogue {
 public:
  ScannedFiles(std::vector<fs::path> paths, const ReadLimits& limits)
      : paths_(std::move(paths)), limits_(limits) {}

  Result<std::vector<std::shared_ptr<const FileRecord>>> files(bool with_footprints,
                                                               const RunContext& context) override {
    auto listed = list_files(paths_);
    if (listed) listed = unpacked(std::move(*listed));
    if (!listed) return listed.error();
    std::vector<Result<std::shared_ptr<const FileScan>>> scans(listed->size(),
                                                               std::shared_ptr<const FileScan>());
    parallel_for(listed->size(), std::max(1u, context.threads),
                 [&](std::size_t i) { scans[i] = scan((*listed)[i], with_footprints, context); });
    std::vector<std::shared_ptr<const FileRecord>> records;
    for (auto& scanned : scans) {
      if (!scanned) return scanned.error();
      records.push_back(std::move(*scanned));
    }
    return records;
  }

  Result<void> buildings(const FileRecord& file, const RecordQuery& query,
                         const RecordSink& sink) override {
    const auto& scan = static_cast<const FileScan&>(file);  // files() gives nothing else
    for (const BuildingRecord& building : scan.records) {
      if (query.box && !query.box->meets(building.extent)) continue;
      if (auto taken = sink(building); !taken) return taken;
    }
    return {};
  }

 private:
  /// Archives are replaced by their members, unpacked once. One that cannot be unpacked stays, to
  /// be reported as a file that cannot be read.
  Result<std::vector<FileRecord>> unpacked(std::vector<FileRecord> files) {
    const std::lock_guard lock(mutex_);
    std::vector<FileRecord> all;
    for (FileRecord& file : files) {
      const auto archive = is_zip(file.path);
      if (!archive || !*archive) {
        all.push_back(std::move(file));
        continue;
      }
      Archive& known = archives_[file.path];
      if (!file.stamp || known.stamp != file.stamp) {
        auto folder = TemporaryFolder::make("to unpack archives");
        if (!folder) return folder.error();
        auto members = unpack_archive(file, folder->path(), limits_);
        if (!members) {
          file.facts.failure = members.error().message;
          known = {};
          all.push_back(std::move(file));
          continue;
        }
        known = {file.stamp, std::move(*folder), std::move(*members)};
      }
      all.insert(all.end(), known.members.begin(), known.members.end());
    }
    return all;
  }

  Result<std::shared_ptr<const FileScan>> scan(const FileRecord& file, bool with_footprints,
                                               const RunContext& context) {
    {
      const std::lock_guard lock(mutex_);
      const auto known = scans_.find({file.path, file.name});
      if (known != scans_.end() && file.stamp && known->second->stamp == file.stamp &&
          (known->second->has_footprints || !with_footprints))
        return known->second;
    }
    auto scanned = scan_file(file, limits_, with_footprints, context.stop);
    if (!scanned) return scanned.error();
    auto kept = std::make_shared<const FileScan>(std::move(*scanned));
    const std::lock_guard lock(mutex_);
    scans_[{file.path, file.name}] = kept;
    return std::shared_ptr<const FileScan>(kept);
  }

  struct Archive {
    std::optional<FileStamp> stamp{};
    TemporaryFolder folder{};
    std::vector<FileRecord> members{};
  };

  std::vector<fs::path> paths_;
  ReadLimits limits_;
  std::mutex mutex_{};
  std::map<fs::path, Archive> archives_{};
  std::map<std::pair<fs::path, std::string>, std::shared_ptr<const FileScan>> scans_{};
};

}  // namespace

Result<std::unique_ptr<CitySource>> open_files(std::vector<fs::path> paths,
                                               FileSourceOptions options) {
  if (paths.empty())
    return fail(ErrorCode::InvalidArgument, "no input: name at least one file or folder");
  if (const auto files = list_files(paths); !files) return files.error();
  const ReadLimits limits = options.limits;
  return open_catalogue(std::make_shared<ScannedFiles>(std::move(paths), limits),
                        std::move(options));
}

}  // namespace citymesh
