#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace citymesh {

/// Owns a file descriptor; closes it.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  int get() const { return fd_; }
  int release();

 private:
  int fd_ = -1;
};

/// A nameless file for what is joined later. It vanishes with the object, also when the process is
/// killed. Errors of all functions: Unavailable with the name and the system's reason.
class Spool {
 public:
  /// `purpose` names it in messages: "model.city.json (vertices)".
  static Result<Spool> create(const std::filesystem::path& folder, std::string purpose);

  Result<void> write(std::string_view bytes);
  std::uint64_t size() const { return size_; }

 private:
  friend class AtomicFile;
  Spool(Descriptor fd, std::string purpose) : fd_(std::move(fd)), purpose_(std::move(purpose)) {}
  Result<void> flush();

  Descriptor fd_;
  std::string purpose_;
  std::string buffer_{};
  std::uint64_t size_ = 0;
};

/// A file that appears under its name only when it is complete. Errors of all functions:
/// Unavailable with the file's name and the system's reason.
class AtomicFile {
 public:
  static Result<AtomicFile> create(const std::filesystem::path& path);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();  ///< removes what was not committed

  Result<void> write(std::string_view bytes);
  Result<void> append(Spool& spool);
  /// Replaces bytes already written.
  Result<void> overwrite(std::uint64_t offset, std::string_view bytes);
  Result<void> commit();

 private:
  AtomicFile(Descriptor fd, std::filesystem::path path);
  Result<void> flush();

  Descriptor fd_;
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::string buffer_{};
};

}  // namespace citymesh
