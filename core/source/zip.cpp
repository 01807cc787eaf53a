#include "core/source/zip.h"

#include <sys/stat.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

namespace citymesh::source {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxMembers = 100'000;
// City models as text shrink to a twentieth; a bomb to a thousandth or, by members that share their
// bytes, much less.
constexpr std::uint64_t kMaxRatio = 200;
constexpr std::uint64_t kHarmlessBytes = 16ull << 20;

struct ArchiveCloser {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct MemberCloser {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};
struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using Archive = std::unique_ptr<zip_t, ArchiveCloser>;
using Output = std::unique_ptr<std::FILE, FileCloser>;

Error system_error(const fs::path& path, int number, const char* action) {
  const auto code = number == ENOENT || number == ENOTDIR ? ErrorCode::NotFound
                    : number == EACCES || number == EPERM ? ErrorCode::PermissionDenied
                                                          : ErrorCode::FailedPrecondition;
  return fail(code, "'" + path.string() + "' cannot be " + action + ": " + std::strerror(number));
}

Result<Archive> open_archive(const fs::path& path) {
  int code = 0;
  if (zip_t* const archive = zip_open(path.c_str(), ZIP_RDONLY, &code)) return Archive(archive);
  const int system = errno;
  if (code == ZIP_ER_NOENT) return system_error(path, ENOENT, "read");
  if (code == ZIP_ER_OPEN) return system_error(path, system, "read");
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  Error failed = fail(ErrorCode::DataLoss,
                      std::string("the zip archive is damaged: ") + zip_error_strerror(&error));
  zip_error_fini(&error);
  return failed;
}

bool is_regular_name(std::string_view name) {
  if (name.empty() || name.back() == '/' || name.back() == '\\') return false;
  while (!name.empty()) {
    const auto part = name.substr(0, name.find_first_of("/\\"));
    const bool hidden = part.size() > 1 && part.front() == '.' && part != "..";
    if (hidden || part == "__MACOSX" || part == "Thumbs.db" || part == "desktop.ini") return false;
    name.remove_prefix(std::min(name.size(), part.size() + 1));
  }
  return true;
}

bool is_regular_file(zip_t* archive, zip_uint64_t index) {
  zip_uint8_t system = ZIP_OPSYS_UNIX;
  zip_uint32_t attributes = 0;
  if (zip_file_get_external_attributes(archive, index, 0, &system, &attributes) != 0) return false;
  if (system != ZIP_OPSYS_UNIX) return true;
  const auto type = static_cast<mode_t>(attributes >> 16) & S_IFMT;
  return type == 0 || type == S_IFREG;  // some programs state none
}

/// Unpacks members one after the other and takes them back unless told that all is well.
class Unpacker {
 public:
  Unpacker(zip_t* archive, std::uint64_t archive_bytes, fs::path folder, const ReadLimits& limits)
      : archive_(archive), folder_(std::move(folder)), max_bytes_(limits.max_file_bytes) {
    max_unpacked_ = std::max(kHarmlessBytes, archive_bytes * kMaxRatio);
  }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
  ~Unpacker() {
    std::error_code ignored;
    for (const ZipMember& member : members_) fs::remove(member.path, ignored);
  }

  Result<void> unpack(zip_uint64_t index, const std::string& name) {
    zip_stat_t status;
    zip_stat_init(&status);
    if (zip_stat_index(archive_, index, 0, &status) != 0) return damaged(name);
    if ((status.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && status.encryption_method != ZIP_EM_NONE)
      return fail(ErrorCode::Unimplemented, quoted(name) + " is encrypted, which is not read");
    const std::unique_ptr<zip_file_t, MemberCloser> file(zip_fopen_index(archive_, index, 0));
    if (!file) return damaged(name);

    ZipMember member{folder_ / std::to_string(members_.size()), name};
    const Output output(std::fopen(member.path.c_str(), "wbxe"));
    if (!output) return not_written(member.path);
    const fs::path path = member.path;
    members_.push_back(std::move(member));
    return copy(*file, *output, path, name);
  }

  std::vector<ZipMember> keep() { return std::exchange(members_, {}); }

 private:
  static std::string quoted(const std::string& name) {
    return "member '" + name.substr(0, 200) + "' of the zip archive";
  }
  static Error not_written(const fs::path& path) {
    Error error = system_error(path, errno, "written");
    error.code = ErrorCode::FailedPrecondition;
    return error;
  }
  static Error refused(const std::string& name, zip_error_t* error) {
    const int code = zip_error_code_zip(error);
    const bool unknown = code == ZIP_ER_COMPNOTSUPP || code == ZIP_ER_ENCRNOTSUPP;
    return fail(
        unknown ? ErrorCode::Unimplemented : ErrorCode::DataLoss,
        quoted(name) + (unknown ? " is not read: " : " is damaged: ") + zip_error_strerror(error));
  }
  Error damaged(const std::string& name) const { return refused(name, zip_get_error(archive_)); }

  Result<void> copy(zip_file_t& file, std::FILE& output, const fs::path& path,
                    const std::string& name) {
    std::array<char, 1u << 16> buffer{};
    for (;;) {
      const zip_int64_t count = zip_fread(&file, buffer.data(), buffer.size());
      if (count < 0) return refused(name, zip_file_get_error(&file));
      if (count == 0) break;
      const auto size = static_cast<std::size_t>(count);
      unpacked_ += size;
      if (unpacked_ > max_bytes_)
        return fail(ErrorCode::ResourceExhausted,
                    "the zip archive has more than max_file_bytes = " + std::to_string(max_bytes_) +
                        " bytes with " + quoted(name));
      if (unpacked_ > max_unpacked_)
        return fail(ErrorCode::ResourceExhausted, "the zip archive unpacks to more than " +
                                                      std::to_string(kMaxRatio) +
                                                      " times its size with " + quoted(name));
      if (std::fwrite(buffer.data(), 1, size, &output) != size) return not_written(path);
    }
    if (std::fflush(&output) != 0) return not_written(path);
    return {};
  }

  zip_t* archive_;
  fs::path folder_;
  std::uint64_t max_bytes_, max_unpacked_ = 0;
  std::uint64_t unpacked_ = 0;
  std::vector<ZipMember> members_{};
};

}  // namespace

Result<bool> is_zip(const fs::path& path) {
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rbe"));
  if (!file) return system_error(path, errno, "read");
  std::array<char, 4> start{};
  const std::size_t count = std::fread(start.data(), 1, start.size(), file.get());
  const std::string_view text(start.data(), count);
  return text == "PK\3\4" || text == "PK\5\6";  // with members, and without any
}

Result<std::vector<ZipMember>> unpack_zip(const fs::path& path, const fs::path& folder,
                                          const ReadLimits& limits) {
  auto archive = open_archive(path);
  if (!archive) return archive.error();
  zip_t* const zip = archive->get();
  const zip_int64_t count = zip_get_num_entries(zip, 0);
  if (count > kMaxMembers)
    return fail(ErrorCode::ResourceExhausted, "the zip archive has " + std::to_string(count) +
                                                  " members, more than " +
                                                  std::to_string(kMaxMembers));
  std::vector<std::pair<std::string, zip_uint64_t>> wanted;
  for (zip_uint64_t i = 0; i < static_cast<zip_uint64_t>(count); ++i) {
    const char* const name = zip_get_name(zip, i, ZIP_FL_ENC_GUESS);
    if (name && is_regular_name(name) && is_regular_file(zip, i)) wanted.emplace_back(name, i);
  }
  std::sort(wanted.begin(), wanted.end());

  std::error_code error;
  const auto bytes = fs::file_size(path, error);
  Unpacker unpacker(zip, error ? 0 : bytes, folder, limits);
  for (const auto& [name, index] : wanted)
    if (auto unpacked = unpacker.unpack(index, name); !unpacked) return unpacked.error();
  return unpacker.keep();
}

}  // namespace citymesh::source
