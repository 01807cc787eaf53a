#include "core/write/output.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

namespace citymesh {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

Error disk_error(std::string_view verb, std::string_view name, int error) {
  return fail(ErrorCode::Unavailable, "cannot " + std::string(verb) + " " + std::string(name) +
                                          ": " + std::generic_category().message(error));
}

Result<void> write_all(int fd, std::string_view bytes, std::string_view name) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return disk_error("write", name, errno);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

/// Large pieces go straight to the file, small ones are collected.
Result<void> buffered_write(int fd, std::string& buffer, std::string_view bytes,
                            std::string_view name) {
  if (buffer.size() + bytes.size() < kBufferBytes) {
    buffer += bytes;
    return {};
  }
  auto written = write_all(fd, buffer, name);
  buffer.clear();
  if (!written) return written;
  if (bytes.size() < kBufferBytes) {
    buffer += bytes;
    return {};
  }
  return write_all(fd, bytes, name);
}

std::filesystem::path part_of(const std::filesystem::path& path) {
  std::filesystem::path part = path;
  part += ".part";
  return part;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    if (fd_ >= 0) ::close(fd_);
    fd_ = other.release();
  }
  return *this;
}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

int Descriptor::release() { return std::exchange(fd_, -1); }

Result<Spool> Spool::create(const std::filesystem::path& folder, std::string purpose) {
  std::string name = (folder / ".spool.XXXXXX").string();
  const int fd = ::mkostemp(name.data(), O_CLOEXEC);
  if (fd < 0) return disk_error("create a temporary file for", purpose, errno);
  ::unlink(name.c_str());
  return Spool(Descriptor(fd), std::move(purpose));
}

Result<void> Spool::write(std::string_view bytes) {
  size_ += bytes.size();
  return buffered_write(fd_.get(), buffer_, bytes, purpose_);
}

Result<void> Spool::flush() {
  auto written = write_all(fd_.get(), buffer_, purpose_);
  buffer_.clear();
  return written;
}

AtomicFile::AtomicFile(Descriptor fd, std::filesystem::path path)
    : fd_(std::move(fd)), path_(std::move(path)), temporary_(part_of(path_)) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : fd_(std::move(other.fd_)),
      path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      buffer_(std::move(other.buffer_)) {}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& path) {
  const int fd = ::open(part_of(path).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return disk_error("create", path.filename().string(), errno);
  return AtomicFile(Descriptor(fd), path);
}

Result<void> AtomicFile::write(std::string_view bytes) {
  return buffered_write(fd_.get(), buffer_, bytes, path_.filename().native());
}

Result<void> AtomicFile::flush() {
  auto written = write_all(fd_.get(), buffer_, path_.filename().native());
  buffer_.clear();
  return written;
}

Result<void> AtomicFile::append(Spool& spool) {
  if (auto flushed = spool.flush(); !flushed) return flushed;
  std::vector<char> chunk(kBufferBytes);
  for (std::uint64_t offset = 0; offset < spool.size_;) {
    const ssize_t got =
        ::pread(spool.fd_.get(), chunk.data(), chunk.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return disk_error("read back", spool.purpose_, got < 0 ? errno : EIO);
    if (auto written = write({chunk.data(), static_cast<std::size_t>(got)}); !written)
      return written;
    offset += static_cast<std::uint64_t>(got);
  }
  return {};
}

Result<void> AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  if (auto flushed = flush(); !flushed) return flushed;
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0) {
      if (errno == EINTR) continue;
      return disk_error("write", path_.filename().native(), errno);
    }
    offset += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> AtomicFile::commit() {
  if (auto flushed = flush(); !flushed) return flushed;
  if (::close(fd_.release()) != 0)  // network file systems report a full disk here
    return disk_error("write", path_.filename().native(), errno);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0)
    return disk_error("rename", path_.filename().native(), errno);
  temporary_.clear();
  return {};
}

}  // namespace citymesh
