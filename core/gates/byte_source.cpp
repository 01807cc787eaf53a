#include "core/gates/byte_source.h"

#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <utility>

#include "core/gates/parse.h"

namespace citymesh {

static_assert(std::endian::native == std::endian::little);

Result<ByteSource> ByteSource::open(const std::filesystem::path& file) {
  ByteSource source;
  source.file_ = file;
  source.fd_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (source.fd_ < 0) return file_error(file, errno);
  const off_t size = ::lseek(source.fd_, 0, SEEK_END);
  if (size < 0) return file_error(file, errno);
  source.size_ = static_cast<std::uint64_t>(size);
  return source;
}

ByteSource::ByteSource(ByteSource&& other) noexcept
    : text_(other.text_),
      file_(std::move(other.file_)),
      fd_(std::exchange(other.fd_, -1)),
      size_(other.size_) {}

ByteSource::~ByteSource() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> ByteSource::read(std::uint64_t offset, std::uint64_t count, std::string_view what,
                              std::string& bytes) const {
  if (offset > size_ || count > size_ - offset)
    return fail(ErrorCode::DataLoss, std::string(what) + ": " + std::to_string(count) +
                                         " bytes from byte " + std::to_string(offset) + " of " +
                                         std::to_string(size_));
  if (fd_ < 0) {
    bytes.assign(text_, static_cast<std::size_t>(offset), static_cast<std::size_t>(count));
    return {};
  }
  bytes.resize(static_cast<std::size_t>(count));
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got =
        ::pread(fd_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return file_error(file_, got < 0 ? errno : EIO);
    done += static_cast<std::size_t>(got);
  }
  return {};
}

}  // namespace citymesh
