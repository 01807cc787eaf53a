#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/base/result.h"

namespace citymesh::source {

/// A file read from front to back; gzip is unpacked on the way.
class ByteReader {
 public:
  /// Errors: NotFound, PermissionDenied.
  static Result<ByteReader> open(const std::filesystem::path& path, std::uint64_t max_bytes);

  /// A text in memory.
  static ByteReader over(std::string text);

  ByteReader(ByteReader&&) noexcept = default;
  ByteReader& operator=(ByteReader&&) noexcept = default;

  /// Up to `size` bytes; 0 at the end. Errors: DataLoss for damaged gzip data, ResourceExhausted
  /// when the file has more than `max_bytes`.
  Result<std::size_t> read(char* buffer, std::size_t size);
  std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  struct Closer {
    void operator()(void* file) const;
  };
  ByteReader(void* file, std::uint64_t max_bytes) : file_(file), max_bytes_(max_bytes) {}

  std::unique_ptr<void, Closer> file_;  ///< none: `text_` is read
  std::string text_{};
  std::uint64_t max_bytes_ = 0;
  std::uint64_t bytes_read_ = 0;
};

/// Whether a file is packed as a whole.
Result<bool> is_gzip(const std::filesystem::path& path);

/// A file read at any offset; gzip is unpacked into a nameless temporary file first.
class RandomReader {
 public:
  static Result<RandomReader> open(const std::filesystem::path& path, std::uint64_t max_bytes);

  RandomReader(RandomReader&&) noexcept = default;
  RandomReader& operator=(RandomReader&&) noexcept = default;

  std::uint64_t size() const { return size_; }
  /// Exactly `size` bytes. Errors: DataLoss.
  Result<void> read(std::uint64_t offset, std::size_t size, char* buffer) const;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  RandomReader(std::FILE* file, std::uint64_t size) : file_(file), size_(size) {}

  std::unique_ptr<std::FILE, Closer> file_;
  std::uint64_t size_ = 0;
};

}  // namespace citymesh::source
