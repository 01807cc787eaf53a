#include "services/apps/input.h"

#include <unistd.h>

#include "services/catalogue/catalogue.h"

namespace citymesh {

Result<std::unique_ptr<CitySource>> open_input(const std::vector<std::filesystem::path>& paths) {
  if (paths.size() == 1) {
    const auto state = default_catalogue(paths.front());
    // A catalogue that cannot be brought up to date may be wrong.
    if (has_catalogue(state) && ::access(state.c_str(), W_OK) == 0)
      return open_catalogued({.data = paths.front(), .state = state});
  }
  return open_files(paths, {});
}

}  // namespace citymesh
