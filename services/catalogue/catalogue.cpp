#include "services/catalogue/catalogue.h"

#include <mutex>
#include <unordered_map>
#include <utility>

#include "services/catalogue/database.h"

namespace citymesh {
namespace {

using namespace source;
using catalogue::Database;

/// Answers from the database, after a look at the folder.
class CataloguedFolder final : public Catalogue {
 public:
  explicit CataloguedFolder(CatalogueOptions options) : options_(std::move(options)) {}

  Result<std::vector<std::shared_ptr<const FileRecord>>> files(bool,
                                                               const RunContext& context) override {
    RunContext quiet = context;
    quiet.on_progress = {};
    auto updated = update_catalogue(options_, quiet);
    if (!updated) return updated.error();
    return guarded([&]() -> Result<std::vector<std::shared_ptr<const FileRecord>>> {
      if (auto opened = open(); !opened) return opened.error();
      auto stored = database_->files(options_.data);
      if (!stored) return stored.error();
      std::vector<std::shared_ptr<const FileRecord>> records;
      for (catalogue::Stored& file : *stored) {
        records.push_back(std::make_shared<const FileRecord>(std::move(file.file)));
        ids_[records.back()->name] = file.id;
      }
      return records;
    });
  }

  Result<void> buildings(const FileRecord& file, const RecordQuery& query,
                         const RecordSink& sink) override {
    return guarded([&]() -> Result<void> {
      if (auto opened = open(); !opened) return opened;
      const auto id = ids_.find(file.name);
      if (id == ids_.end())
        return fail(ErrorCode::Internal, "file '" + file.name + "' is not of this catalogue");
      return database_->buildings(id->second, query, sink);
    });
  }

 private:
  template <class Work>
  auto guarded(const Work& work) -> decltype(work()) {
    const std::lock_guard lock(mutex_);
    try {
      return work();
    } catch (const sqlite::Failure& failure) {
      return sqlite::as_error(failure, "catalogue '" + options_.state.string() + "'");
    }
  }

  Result<void> open() {
    if (database_) return {};
    auto opened = Database::open(options_.state);
    if (!opened) return opened.error();
    database_ = std::move(*opened);
    return {};
  }

  CatalogueOptions options_;
  std::mutex mutex_{};
  std::unique_ptr<Database> database_{};
  std::unordered_map<std::string, std::int64_t> ids_{};
};

}  // namespace

Result<std::unique_ptr<CitySource>> open_catalogued(const CatalogueOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_directory(options.data, error))
    return fail(error ? ErrorCode::NotFound : ErrorCode::InvalidArgument,
                "'" + options.data.string() + "' is no folder that can be read" +
                    (error ? ": " + error.message() : std::string()));
  return open_catalogue(std::make_shared<CataloguedFolder>(options), options.source);
}

}  // namespace citymesh
