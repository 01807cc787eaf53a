#include "services/apps/input.h"

#include "services/catalogue/catalogue.h"

namespace citymesh {

Result<std::unique_ptr<CitySource>> open_input(const std::vector<std::filesystem::path>& paths) {
  if (paths.size() == 1)
    if (const auto state = default_catalogue(paths.front()); has_catalogue(state))
      return open_catalogued({.data = paths.front(), .state = state});
  return open_files(paths, {});
}

}  // namespace citymesh
