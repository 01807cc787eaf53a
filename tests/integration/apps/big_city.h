#pragma once

#include <filesystem>

namespace citymesh {

/// A folder of `tiles` files with 166 real buildings each, all ids different: work for some
/// seconds, so that a test can interrupt it.
void make_big_city(const std::filesystem::path& folder, int tiles);

}  // namespace citymesh
