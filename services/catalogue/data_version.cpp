#include "services/catalogue/data_version.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <system_error>

#include "core/source/listing.h"

namespace citymesh {

std::string data_version(const std::filesystem::path& data) {
  std::error_code error;
  const auto place = std::filesystem::absolute(data, error);
  if (error) return {};
  const auto files = source::list_files({place});
  if (!files) return {};
  std::string version = place.string();
  for (const auto& file : *files) {
    struct stat facts {};
    if (::stat(file.path.c_str(), &facts) != 0) return {};
    // What no file name can have separates them.
    version += fmt::format("{}{}{}{} {}.{:09} {}.{:09}", '\0', file.name, '\0', facts.st_size,
                           facts.st_mtim.tv_sec, facts.st_mtim.tv_nsec, facts.st_ctim.tv_sec,
                           facts.st_ctim.tv_nsec);
  }
  return version;
}

}  // namespace citymesh
