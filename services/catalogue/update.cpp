#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <set>
#include <system_error>

#include "core/base/parallel.h"
#include "core/source/listing.h"
#include "services/catalogue/catalogue.h"
#include "services/catalogue/database.h"
#include "services/catalogue/unpack.h"

namespace citymesh {
namespace {

namespace fs = std::filesystem;
using namespace source;
using catalogue::copies_of;
using catalogue::Database;
using catalogue::KnownSource;

/// One pass over the folder.
class Update {
 public:
  Update(const CatalogueOptions& options, Database& database, const RunContext& context)
      : options_(options), database_(database), context_(context) {}

  Result<CatalogueReport> run() {
    const auto files = list_files({options_.data});
    if (!files) return files.error();
    std::vector<const FileRecord*> due;
    std::set<std::string> present;
    for (const FileRecord& file : *files) {
      present.insert(file.name);
      const auto known = database_.find(file.name);
      if (known && file.stamp && known->stamp == *file.stamp)
        ++report_.unchanged;
      else
        due.push_back(&file);
    }
    for (const std::string& name : database_.sources()) {
      if (present.contains(name)) continue;
      remove(name);
      ++report_.removed;
    }

    std::atomic<std::uint64_t> done = 0;
    parallel_for(due.size(), std::max(1u, context_.threads), [&](std::size_t i) {
      if (failure_found()) return;
      auto indexed = index(*due[i]);
      const std::lock_guard lock(mutex_);
      if (!indexed && !failure_) failure_ = indexed.error();
      context_.report({"index", ++done, due.size()});
    });
    if (failure_) return *failure_;
    report_.files = files->size();
    report_.buildings = static_cast<std::uint64_t>(database_.building_count());
    return report_;
  }

 private:
  bool failure_found() {
    const std::lock_guard lock(mutex_);
    if (!failure_ && context_.stopped())
      failure_ = fail(ErrorCode::Cancelled, "indexing was stopped");
    return failure_.has_value();
  }

  void remove(const std::string& name) {
    const auto known = database_.find(name);
    database_.remove(name);
    std::error_code ignored;
    if (known) fs::remove_all(copies_of(options_.state, name, known->hash), ignored);
  }

  Result<void> index(const FileRecord& file) {
    if (!file.stamp) return {};  // gone since it was listed
    const auto hash = catalogue::content_hash(file.path);
    if (!hash) return note(file.name, hash.error());
    std::optional<KnownSource> known;
    {
      const std::lock_guard lock(mutex_);
      known = database_.find(file.name);
      if (known && known->hash == *hash) {
        database_.touch(file.name, *file.stamp);
        ++report_.unchanged;
        return {};
      }
    }

    auto texts = catalogue::unpack(file, copies_of(options_.state, file.name, *hash),
                                   options_.source.limits);
    std::vector<FileScan> scans;
    if (texts) {
      for (FileRecord& text : *texts) {
        auto scan = scan_file(std::move(text), options_.source.limits, true, context_.stop);
        if (!scan) return scan.error();
        scans.push_back(std::move(*scan));
      }
    } else if (texts.error().code == ErrorCode::Unavailable) {
      return texts.error();
    } else {
      FileScan& failed = scans.emplace_back(FileScan{file});
      failed.facts.failure = texts.error().message;
      failed.srs.resize(failed.facts.srs_names.size());
    }

    const std::lock_guard lock(mutex_);
    ++report_.indexed;
    for (const FileScan& scan : scans) {
      std::error_code ignored;
      report_.bytes += fs::file_size(scan.text, ignored);
      if (!scan.facts.failure.empty() && !scan.facts.not_a_city_model)
        report_.problems.emplace_back(scan.name, scan.facts.failure);
    }
    database_.replace(file.name, {*file.stamp, *hash}, scans);
    std::error_code ignored;
    if (known) fs::remove_all(copies_of(options_.state, file.name, known->hash), ignored);
    return {};
  }

  Result<void> note(const std::string& name, const Error& error) {
    const std::lock_guard lock(mutex_);
    report_.problems.emplace_back(name, error.message);
    return {};
  }

  const CatalogueOptions& options_;
  Database& database_;
  const RunContext& context_;
  std::mutex mutex_{};  ///< of all below, and of the database
  CatalogueReport report_{};
  std::optional<Error> failure_{};
};

}  // namespace

fs::path default_catalogue(const fs::path& data) { return data / ".citymesh"; }

bool has_catalogue(const fs::path& state) {
  std::error_code ignored;
  return fs::exists(state / "catalogue.sqlite", ignored);
}

Result<CatalogueReport> update_catalogue(const CatalogueOptions& options,
                                         const RunContext& context) {
  std::error_code error;
  fs::create_directories(options.state, error);
  if (error)
    return fail(ErrorCode::Unavailable, fmt::format("cannot make folder '{}': {}",
                                                    options.state.string(), error.message()));
  try {
    auto database = Database::open(options.state);
    if (!database) return database.error();
    return Update(options, **database, context).run();
  } catch (const sqlite::Failure& failure) {
    return sqlite::as_error(failure, "catalogue '" + options.state.string() + "'");
  }
}

}  // namespace citymesh
