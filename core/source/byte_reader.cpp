#include "core/source/byte_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

namespace citymesh::source {
namespace {

constexpr std::size_t kChunk = 1u << 18;

Error open_error(const std::filesystem::path& path, int number) {
  const auto code = number == ENOENT || number == ENOTDIR ? ErrorCode::NotFound
                    : number == EACCES || number == EPERM ? ErrorCode::PermissionDenied
                                                          : ErrorCode::FailedPrecondition;
  return fail(code, "'" + path.string() + "' cannot be read: " + std::strerror(number));
}

bool starts_as_gzip(std::FILE* file) {
  std::array<unsigned char, 2> magic{};
  const bool is_gzip = std::fread(magic.data(), 1, magic.size(), file) == magic.size() &&
                       magic[0] == 0x1f && magic[1] == 0x8b;
  std::rewind(file);
  return is_gzip;
}

}  // namespace

void ByteReader::Closer::operator()(void* file) const { gzclose_r(static_cast<gzFile>(file)); }

Result<ByteReader> ByteReader::open(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return open_error(path, errno);
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode)) {
    ::close(descriptor);
    return open_error(path, EISDIR);
  }
  gzFile file = gzdopen(descriptor, "rb");
  if (!file) {
    ::close(descriptor);
    return fail(ErrorCode::ResourceExhausted, "no memory to read '" + path.string() + "'");
  }
  gzbuffer(file, kChunk);
  return ByteReader(file, max_bytes);
}

ByteReader ByteReader::over(std::string text) {
  ByteReader reader(nullptr, text.size());
  reader.text_ = std::move(text);
  return reader;
}

Result<std::size_t> ByteReader::read(char* buffer, std::size_t size) {
  if (!file_) {
    const std::size_t count = std::min(size, text_.size() - static_cast<std::size_t>(bytes_read_));
    std::memcpy(buffer, text_.data() + bytes_read_, count);
    bytes_read_ += count;
    return count;
  }
  const auto file = static_cast<gzFile>(file_.get());
  const int count = gzread(file, buffer, static_cast<unsigned>(std::min(size, kChunk)));
  int code = Z_OK;
  const char* reason = gzerror(file, &code);
  // A gzip stream that just stops is no read error to zlib, only an unfinished stream.
  if (count < 0 || code == Z_BUF_ERROR)
    return fail(ErrorCode::DataLoss, std::string("the file is damaged: ") +
                                         (code == Z_ERRNO ? std::strerror(errno) : reason));
  bytes_read_ += static_cast<std::uint64_t>(count);
  if (bytes_read_ > max_bytes_)
    return fail(ErrorCode::ResourceExhausted,
                "the file has more than max_file_bytes = " + std::to_string(max_bytes_) + " bytes");
  return static_cast<std::size_t>(count);
}

Result<bool> is_gzip(const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "rbe");
  if (!file) return open_error(path, errno);
  const bool packed = starts_as_gzip(file);
  std::fclose(file);
  return packed;
}

Result<RandomReader> RandomReader::open(const std::filesystem::path& path,
                                        std::uint64_t max_bytes) {
  std::FILE* file = std::fopen(path.c_str(), "rbe");
  if (!file) return open_error(path, errno);
  RandomReader plain(file, 0);
  if (!starts_as_gzip(file)) {
    struct stat status {};
    if (::fstat(::fileno(file), &status) != 0) return open_error(path, errno);
    if (S_ISDIR(status.st_mode)) return open_error(path, EISDIR);
    plain.size_ = static_cast<std::uint64_t>(status.st_size);
    if (plain.size_ > max_bytes)
      return fail(ErrorCode::ResourceExhausted,
                  "the file has " + std::to_string(plain.size_) +
                      " bytes, more than max_file_bytes = " + std::to_string(max_bytes));
    return plain;
  }

  auto packed = ByteReader::open(path, max_bytes);
  if (!packed) return packed.error();
  std::FILE* temporary = std::tmpfile();
  if (!temporary) return open_error("temporary file", errno);
  RandomReader unpacked(temporary, 0);
  std::vector<char> chunk(kChunk);
  for (;;) {
    const auto count = packed->read(chunk.data(), chunk.size());
    if (!count) return count.error();
    if (*count == 0) break;
    if (std::fwrite(chunk.data(), 1, *count, temporary) != *count)
      return open_error("temporary file", errno);
  }
  if (std::fflush(temporary) != 0) return open_error("temporary file", errno);
  unpacked.size_ = packed->bytes_read();
  return unpacked;
}

Result<void> RandomReader::read(std::uint64_t offset, std::size_t size, char* buffer) const {
  while (size > 0) {
    const auto count = ::pread(::fileno(file_.get()), buffer, size, static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      return fail(ErrorCode::DataLoss, "the file ends at byte " + std::to_string(offset) +
                                           " although it had " + std::to_string(size_));
    buffer += count;
    offset += static_cast<std::uint64_t>(count);
    size -= static_cast<std::size_t>(count);
  }
  return {};
}

}  // namespace citymesh::source
