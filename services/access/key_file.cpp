#include "services/access/key_file.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <system_error>

namespace citymesh {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostFileBytes = 16 << 20;

}  // namespace

FileState state_of(const fs::path& file) {
  std::error_code ignored;
  FileState state;
  if (file.empty()) return state;
  state.written = fs::last_write_time(file, ignored);
  state.bytes = fs::file_size(file, ignored);
  return state;
}

Result<std::string> read_key_file(const fs::path& file) {
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  std::ifstream input(file, std::ios::binary);
  if (error || !input)
    return fail(ErrorCode::NotFound, fmt::format("'{}' cannot be read", file.string()));
  if (bytes > kMostFileBytes)
    return fail(ErrorCode::InvalidArgument, fmt::format("'{}' has {} bytes, expected at most {}",
                                                        file.string(), bytes, kMostFileBytes));
  return std::string(std::istreambuf_iterator<char>(input), {});
}

Error named(const std::string& where, const Error& error) {
  return fail(error.code, fmt::format("'{}': {}", where, error.message));
}

}  // namespace citymesh
