#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/source/scan.h"
#include "services/sqlite/sqlite.h"

namespace citymesh::catalogue {

/// A file of the data folder, which may hold several city models, as the catalogue knows it.
struct KnownSource {
  source::FileStamp stamp{};
  std::string hash{};
};

struct Stored {
  std::int64_t id = 0;
  source::FileRecord file{};
};

/// The tables of a catalogue. One connection, one thread at a time. All functions but open() throw
/// sqlite::Failure.
class Database {
 public:
  /// Opens or makes it. Errors: Unavailable; FailedPrecondition when another version made it;
  /// DataLoss.
  static Result<std::unique_ptr<Database>> open(const std::filesystem::path& state);

  std::optional<KnownSource> find(const std::string& source);
  std::vector<std::string> sources();
  void touch(const std::string& source, const source::FileStamp& stamp);

  /// Replaces all that is known of a source, in one transaction.
  void replace(const std::string& source, const KnownSource& known,
               const std::vector<source::FileScan>& files);
  void remove(const std::string& source);

  /// In the order of their names. Texts are paths below `state` or, when empty, the source itself.
  Result<std::vector<Stored>> files(const std::filesystem::path& data);
  Result<void> buildings(std::int64_t file, const source::RecordQuery& query,
                         const source::RecordSink& sink);
  std::int64_t building_count();

 private:
  Database(const std::filesystem::path& state);
  void remove_rows(const std::string& source);
  void insert(const std::string& source, const source::FileScan& file);

  std::filesystem::path state_;
  sqlite::Connection connection_;
};

}  // namespace citymesh::catalogue
