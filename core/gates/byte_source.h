#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace citymesh {

/// Bytes of a text or of a file by their place.
class ByteSource {
 public:
  explicit ByteSource(std::string_view text) : text_(text), size_(text.size()) {}
  /// Errors: NotFound, Unavailable.
  static Result<ByteSource> open(const std::filesystem::path& file);
  ByteSource(ByteSource&& other) noexcept;
  ByteSource& operator=(ByteSource&&) = delete;
  ~ByteSource();

  std::uint64_t size() const { return size_; }

  /// Replaces `bytes` by `count` bytes from `offset`. Errors: DataLoss when they are not all there,
  /// `what` names them; Unavailable.
  Result<void> read(std::uint64_t offset, std::uint64_t count, std::string_view what,
                    std::string& bytes) const;

 private:
  ByteSource() = default;

  std::string_view text_{};
  std::filesystem::path file_{};
  int fd_ = -1;
  std::uint64_t size_ = 0;
};

/// A little-endian number; `at` must lie within `bytes`.
template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace citymesh
