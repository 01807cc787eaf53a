#include "services/stores/state_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace citymesh {
namespace {

Error unusable(const std::filesystem::path& folder, std::error_code code) {
  return fail(ErrorCode::Unavailable,
              fmt::format("state folder '{}' cannot be used: {}; expected a folder that can be "
                          "written",
                          folder.string(), code.message()));
}

std::error_code last_error() { return {errno, std::generic_category()}; }

bool take(int lock, int kind) {
  while (::flock(lock, kind) != 0)
    if (errno != EINTR) return false;
  return true;
}

}  // namespace

Result<StateFolder> StateFolder::open(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return unusable(folder, error);
  const auto path = folder / "lock";
  const int lock = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock < 0) return unusable(folder, last_error());
  StateFolder state(folder, lock, take(lock, LOCK_EX | LOCK_NB));
  if (!state.alone_ && !take(lock, LOCK_SH)) return unusable(folder, last_error());
  return state;
}

StateFolder::StateFolder(std::filesystem::path folder, int lock, bool alone)
    : folder_(std::move(folder)), lock_(lock), alone_(alone) {}

StateFolder::StateFolder(StateFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      lock_(std::exchange(other.lock_, -1)),
      alone_(other.alone_) {}

StateFolder& StateFolder::operator=(StateFolder&& other) noexcept {
  std::swap(folder_, other.folder_);
  std::swap(lock_, other.lock_);
  std::swap(alone_, other.alone_);
  return *this;
}

StateFolder::~StateFolder() {
  if (lock_ >= 0) ::close(lock_);
}

Result<void> StateFolder::share() {
  if (!take(lock_, LOCK_SH)) return unusable(folder_, last_error());
  return {};
}

}  // namespace citymesh
