#include "services/apps/output_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <system_error>
#include <utility>

#include "core/write/write.h"

namespace citymesh {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStagedPrefix = ".citymesh-";

Error unusable(const fs::path& folder, std::error_code code) {
  return fail(ErrorCode::Unavailable,
              fmt::format("output folder '{}' cannot be used: {}; expected a folder that can be "
                          "written",
                          folder.string(), code.message()));
}

Result<fs::path> make_staged(const fs::path& folder) {
  auto name = (folder / (std::string(kStagedPrefix) + "XXXXXX")).string();
  if (mkdtemp(name.data()) == nullptr)
    return unusable(folder, std::error_code(errno, std::generic_category()));
  return fs::path(name);
}

/// Every name that a run may write.
std::set<std::string> result_names() {
  std::set<std::string> names{"report.json", "report.html", "picture.svg", "errors.glb",
                              "run.json"};
  for (const auto& format : formats()) {
    names.emplace(format.file_name);
    if (!format.sidecar.empty()) names.emplace(format.sidecar);
  }
  return names;
}

}  // namespace

Result<OutputFolder> OutputFolder::open(const fs::path& folder, bool overwrite) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return unusable(folder, error);
  fs::directory_iterator entries(folder, error);
  if (error) return unusable(folder, error);
  if (!overwrite)
    for (const auto& entry : entries)
      if (const auto name = entry.path().filename().string(); !name.starts_with(kStagedPrefix))
        return fail(ErrorCode::FailedPrecondition,
                    fmt::format("output folder '{}' is not empty (it holds '{}'); expected an "
                                "empty one, or --overwrite to replace earlier results",
                                folder.string(), name));
  auto staged = make_staged(folder);
  if (!staged) return staged.error();
  return OutputFolder(folder, *std::move(staged));
}

Result<OutputFolder> OutputFolder::temporary() {
  std::error_code error;
  const auto base = fs::temp_directory_path(error);
  if (error) return unusable(base, error);
  auto staged = make_staged(base);
  if (!staged) return staged.error();
  return OutputFolder(*staged, *staged);
}

OutputFolder::OutputFolder(fs::path folder, fs::path staged)
    : folder_(std::move(folder)), staged_(std::move(staged)) {}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : folder_(std::move(other.folder_)), staged_(std::exchange(other.staged_, {})) {}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!staged_.empty()) fs::remove_all(staged_, ignored);
}

Result<void> OutputFolder::publish(const std::vector<std::string>& files) {
  std::error_code error;
  for (const auto& name : result_names())
    if (std::ranges::find(files, name) == files.end()) {
      fs::remove(folder_ / name, error);
      if (error) return unusable(folder_, error);
    }
  for (const auto& name : files) {
    fs::rename(staged_ / name, folder_ / name, error);
    if (error) return unusable(folder_, error);
  }
  return {};
}

}  // namespace citymesh
