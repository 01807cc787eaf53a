#include "services/stores/folder_results.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

namespace citymesh {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kAttempt = "attempt-";
constexpr std::string_view kPartial = ".partial";

class FileDescriptor {
 public:
  explicit FileDescriptor(int value) : value_(value) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (value_ >= 0) ::close(value_);
  }
  int get() const { return value_; }
  bool open() const { return value_ >= 0; }

 private:
  int value_;
};

Error unavailable(std::string_view what, const fs::path& path, std::error_code code) {
  return fail(ErrorCode::Unavailable,
              fmt::format("cannot {} '{}': {}", what, path.string(), code.message()));
}

std::error_code last_error() { return {errno, std::generic_category()}; }

/// A name that stays inside its folder.
bool is_bare(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

std::string attempt_name(std::uint32_t attempt) { return fmt::format("{}{}", kAttempt, attempt); }

struct AttemptFolder {
  std::uint32_t attempt = 0;
  bool partial = false;
};

std::optional<AttemptFolder> parse_attempt(std::string_view name) {
  AttemptFolder folder;
  if (!name.starts_with(kAttempt)) return std::nullopt;
  name.remove_prefix(kAttempt.size());
  if (name.ends_with(kPartial)) {
    folder.partial = true;
    name.remove_suffix(kPartial.size());
  }
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), folder.attempt);
  if (error != std::errc{} || end != name.data() + name.size()) return std::nullopt;
  return folder;
}

std::optional<fs::path> committed(const fs::path& job_folder) {
  std::optional<std::uint32_t> last;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(job_folder, ignored)) {
    const auto folder = parse_attempt(entry.path().filename().string());
    if (folder && !folder->partial) last = std::max(last.value_or(0), folder->attempt);
  }
  if (!last) return std::nullopt;
  return job_folder / attempt_name(*last);
}

Result<void> flush(const fs::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!file.open() || ::fsync(file.get()) != 0)
    return unavailable("write to disk", path, last_error());
  return {};
}

Error no_result_file(const std::string& job_id, const std::string& file_name) {
  return fail(ErrorCode::NotFound,
              fmt::format("job '{}' has no result file '{}'", job_id, file_name));
}

/// False when there is no such file.
Result<bool> link_or_copy(const fs::path& from, const fs::path& to) {
  if (::link(from.c_str(), to.c_str()) == 0) return true;
  std::error_code error = last_error();
  // Some file systems know no links, and a file can only have so many of them.
  if (error != std::errc::no_such_file_or_directory) fs::copy_file(from, to, error);
  if (error == std::errc::no_such_file_or_directory) return false;
  if (error) return unavailable("copy", from, error);
  return true;
}

/// Opens a committed file and tells its size.
Result<std::uint64_t> open_result(const fs::path& root, const std::string& job_id,
                                  const std::string& file_name,
                                  const std::function<Result<void>(int, std::uint64_t)>& use) {
  const auto missing = [&] { return no_result_file(job_id, file_name); };
  if (!is_bare(job_id) || !is_bare(file_name)) return missing();
  const auto folder = committed(root / job_id);
  if (!folder) return missing();
  const auto path = *folder / file_name;
  // No links, and no waiting for the other end of a pipe.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!file.open()) {
    const auto error = last_error();
    if (error == std::errc::no_such_file_or_directory ||
        error == std::errc::too_many_symbolic_link_levels || error == std::errc::filename_too_long)
      return missing();
    return unavailable("read", path, error);
  }
  struct stat facts {};
  if (::fstat(file.get(), &facts) != 0) return unavailable("read", path, last_error());
  if (!S_ISREG(facts.st_mode)) return missing();
  const auto bytes = static_cast<std::uint64_t>(facts.st_size);
  if (auto used = use(file.get(), bytes); !used) return used.error();
  return bytes;
}

}  // namespace

Result<std::unique_ptr<FolderResultStore>> FolderResultStore::open(const fs::path& root) {
  std::error_code error;
  fs::create_directories(root, error);
  if (error) return unavailable("create folder", root, error);
  return std::unique_ptr<FolderResultStore>(new FolderResultStore(root));
}

Result<fs::path> FolderResultStore::stage(const std::string& job_id, std::uint32_t attempt) {
  if (!is_bare(job_id))
    return fail(ErrorCode::InvalidArgument, fmt::format("'{}' is not a job id", job_id));
  const auto job_folder = root_ / job_id;
  std::error_code error;
  fs::create_directories(job_folder, error);
  if (error) return unavailable("create folder", job_folder, error);

  // Only what is older goes: a late worker must not clear its successor's folder.
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(job_folder, error)) {
    const auto folder = parse_attempt(entry.path().filename().string());
    if (folder && folder->attempt <= attempt) old.push_back(entry.path());
  }
  for (const auto& path : old) {
    fs::remove_all(path, error);
    if (error) return unavailable("clear", path, error);
  }
  auto folder = job_folder / (attempt_name(attempt) + std::string(kPartial));
  fs::create_directory(folder, error);
  if (error) return unavailable("create folder", folder, error);
  return folder;
}

Result<void> FolderResultStore::reuse(const std::string& from_job_id,
                                      const std::vector<ResultFile>& files,
                                      const std::string& job_id, std::uint32_t attempt) {
  if (!is_bare(from_job_id) || !is_bare(job_id))
    return fail(ErrorCode::InvalidArgument,
                fmt::format("'{}' and '{}' are not both job ids", from_job_id, job_id));
  const auto from = committed(root_ / from_job_id);
  const auto to = root_ / job_id / (attempt_name(attempt) + std::string(kPartial));
  for (const auto& file : files) {
    const auto& name = file.file_name;
    if (!from || !is_bare(name)) return no_result_file(from_job_id, name);
    const auto there = link_or_copy(*from / name, to / name);
    if (!there) return there.error();
    if (!*there) return no_result_file(from_job_id, name);
  }
  return {};
}

Result<void> FolderResultStore::commit(const std::string& job_id, std::uint32_t attempt) {
  if (!is_bare(job_id))
    return fail(ErrorCode::InvalidArgument, fmt::format("'{}' is not a job id", job_id));
  const auto job_folder = root_ / job_id;
  const auto final_folder = job_folder / attempt_name(attempt);
  const auto folder = job_folder / (attempt_name(attempt) + std::string(kPartial));

  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) return unavailable("list", folder, error);
  for (const auto& entry : entries)
    if (auto flushed = flush(entry.path()); !flushed) return flushed;
  if (auto flushed = flush(folder); !flushed) return flushed;
  fs::rename(folder, final_folder, error);
  if (error) return unavailable("publish", final_folder, error);
  if (auto flushed = flush(job_folder); !flushed) return flushed;
  return flush(root_);
}

Result<void> FolderResultStore::discard(const std::string& job_id, std::uint32_t attempt) {
  if (!is_bare(job_id))
    return fail(ErrorCode::InvalidArgument, fmt::format("'{}' is not a job id", job_id));
  const auto job_folder = root_ / job_id;
  for (const auto& name : {attempt_name(attempt), attempt_name(attempt) + std::string(kPartial)}) {
    std::error_code error;
    fs::remove_all(job_folder / name, error);
    if (error) return unavailable("remove", job_folder / name, error);
  }
  std::error_code not_empty;
  fs::remove(job_folder, not_empty);  // goes when this was the only attempt
  return {};
}

Result<std::string> FolderResultStore::read(const std::string& job_id, const std::string& file_name,
                                            std::uint64_t offset, std::uint64_t max_bytes) {
  std::string bytes;
  const auto opened =
      open_result(root_, job_id, file_name, [&](int file, std::uint64_t size) -> Result<void> {
        if (offset >= size) return {};
        bytes.resize(std::min(max_bytes, size - offset));
        std::size_t filled = 0;
        while (filled < bytes.size()) {
          const auto got = ::pread(file, bytes.data() + filled, bytes.size() - filled,
                                   static_cast<off_t>(offset + filled));
          if (got < 0 && errno == EINTR) continue;
          if (got < 0) return unavailable("read", file_name, last_error());
          if (got == 0) break;
          filled += static_cast<std::size_t>(got);
        }
        bytes.resize(filled);
        return {};
      });
  if (!opened) return opened.error();
  return bytes;
}

Result<std::uint64_t> FolderResultStore::size(const std::string& job_id,
                                              const std::string& file_name) {
  return open_result(root_, job_id, file_name,
                     [](int, std::uint64_t) -> Result<void> { return {}; });
}

Result<void> FolderResultStore::erase(const std::string& job_id) {
  if (!is_bare(job_id))
    return fail(ErrorCode::NotFound, fmt::format("'{}' is not a job id", job_id));
  std::error_code error;
  fs::remove_all(root_ / job_id, error);
  if (error) return unavailable("remove", root_ / job_id, error);
  return {};
}

}  // namespace citymesh
