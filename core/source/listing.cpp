#include "core/source/listing.h"

#include <algorithm>
#include <system_error>

#include "core/source/zip.h"

namespace citymesh::source {
namespace {

namespace fs = std::filesystem;

Error path_error(const fs::path& path, const std::error_code& error) {
  const auto code =
      error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory
          ? ErrorCode::NotFound
      : error == std::errc::permission_denied ? ErrorCode::PermissionDenied
                                              : ErrorCode::FailedPrecondition;
  return fail(code, "input '" + path.string() + "' cannot be read: " + error.message());
}

FileRecord record_of(const fs::path& path, bool found_in_folder) {
  return {.path = path,
          .name = path.filename().string(),
          .found_in_folder = found_in_folder,
          .text = path,
          .stamp = FileStamp::of(path)};
}

}  // namespace

Result<std::vector<FileRecord>> list_files(const std::vector<fs::path>& paths) {
  std::vector<FileRecord> files;
  for (const fs::path& path : paths) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error) return path_error(path, error);
    if (!fs::is_directory(status)) {
      files.push_back(record_of(path, false));
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
    for (const fs::path& file : found) files.push_back(record_of(file, true));
  }
  return files;
}

Result<std::vector<FileRecord>> unpack_archive(const FileRecord& archive, const fs::path& folder,
                                               const ReadLimits& limits) {
  auto members = unpack_zip(archive.path, folder, limits);
  if (!members) return members.error();
  std::vector<FileRecord> files;
  for (const ZipMember& member : *members) {
    FileRecord& file = files.emplace_back(archive);
    file.text = member.path;
    file.name = archive.name + "/" + member.name;
    file.found_in_folder = true;
  }
  return files;
}

}  // namespace citymesh::source
