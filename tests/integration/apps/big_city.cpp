#include "tests/integration/apps/big_city.h"

#include <fstream>
#include <sstream>
#include <string>

namespace citymesh {
namespace {

std::string replaced(const std::string& text, const std::string& what, const std::string& with) {
  std::string result;
  std::size_t from = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, from)) {
    result.append(text, from, at - from).append(with);
    from = at + what.size();
  }
  return result.append(text, from);
}

}  // namespace

void make_big_city(const std::filesystem::path& folder, int tiles) {
  std::filesystem::create_directories(folder);
  std::ifstream file(CITYMESH_TEST_DATA "/berlin/3910_5817.gml", std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  for (int tile = 0; tile < tiles; ++tile) {
    const auto prefix = "t" + std::to_string(tile) + "_";
    const auto ids = replaced(text.str(), "gml:id=\"", "gml:id=\"" + prefix);
    std::ofstream(folder / (prefix + "berlin.gml"), std::ios::binary)
        << replaced(ids, "xlink:href=\"#", "xlink:href=\"#" + prefix);
  }
}

}  // namespace citymesh
