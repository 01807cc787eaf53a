#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/write/write.h"
#include "tests/unit/write/files.h"

namespace citymesh::test {

inline const Scene kScene{{"EPSG:25833"}, {391000, 5820000, 0}, "export-for-simulation"};

inline std::string write_scene(const std::filesystem::path& folder, std::string_view key,
                               const std::vector<BuildingBodies>& buildings,
                               const Scene& scene = kScene) {
  const Format& format = *find_format(key);
  auto writer = open_writer(format, folder, scene);
  EXPECT_TRUE(writer);
  for (const auto& building : buildings) EXPECT_TRUE(writer.value()->add(building));
  EXPECT_TRUE(writer.value()->finish());
  return read_file(folder / format.file_name);
}

inline std::string encode(std::string_view key, const BuildingBodies& building,
                          const Scene& scene = kScene) {
  TemporaryFolder folder;
  auto writer = open_writer(*find_format(key), folder.path(), scene);
  auto text = writer.value()->encode(building);
  EXPECT_TRUE(text) << text.error().message;
  return text ? *text : std::string();
}

}  // namespace citymesh::test
