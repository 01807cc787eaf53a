#include "services/catalogue/data_version.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

namespace fs = std::filesystem;

class DataVersion : public testing::Test {
 protected:
  DataVersion() {
    write("a.gml", "one");
    write("b.gml", "two");
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }

  /// Whether the version is another one after `change`.
  template <class Change>
  bool changes(Change&& change) {
    const auto before = data_version(folder_.path());
    change();
    const auto after = data_version(folder_.path());
    EXPECT_FALSE(after.empty());
    return before != after;
  }

  TempFolder folder_;
};

TEST_F(DataVersion, StaysWhileNothingChanges) {
  EXPECT_FALSE(changes([] {}));
  // The catalogue is kept there, too, in a hidden folder.
  EXPECT_FALSE(changes([&] { fs::create_directory(folder_ / ".citymesh"); }));
}

TEST_F(DataVersion, TellsOfEveryFileThatComesGoesOrChanges) {
  EXPECT_TRUE(changes([&] { write("c.gml", "three"); }));
  EXPECT_TRUE(changes([&] { write("a.gml", "longer"); }));
  EXPECT_TRUE(changes([&] { fs::rename(folder_ / "b.gml", folder_ / "d.gml"); }));
  EXPECT_TRUE(changes([&] { fs::remove(folder_ / "c.gml"); }));
}

TEST_F(DataVersion, TellsOfAFileThatHasTheTimeAndSizeOfTheOneBefore) {
  const auto time = fs::last_write_time(folder_ / "a.gml");
  EXPECT_TRUE(changes([&] {
    fs::rename(folder_ / "a.gml", folder_ / ".old");
    write("a.gml", "six");
    fs::last_write_time(folder_ / "a.gml", time);
  }));
}

TEST_F(DataVersion, TellsOneFolderFromAnother) {
  const TempFolder other;
  EXPECT_NE(data_version(folder_.path()), data_version(other.path()));
  EXPECT_FALSE(data_version(other.path()).empty());
}

TEST_F(DataVersion, OfAFileIsItsOwn) {
  const auto before = data_version(folder_ / "a.gml");
  write("b.gml", "another");
  EXPECT_EQ(data_version(folder_ / "a.gml"), before);
  write("a.gml", "another");
  EXPECT_NE(data_version(folder_ / "a.gml"), before);
}

TEST_F(DataVersion, IsUnknownWhereNothingIs) { EXPECT_EQ(data_version(folder_ / "none"), ""); }

}  // namespace
}  // namespace citymesh
