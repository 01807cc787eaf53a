#include "services/apps/serve_flags.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

class ServeSettings : public testing::Test {
 protected:
  ~ServeSettings() override {
    unsetenv("CITYMESH_WORKERS");
    unsetenv("CITYMESH_CONFIG");
  }

  std::string config(const std::string& text) {
    const auto file = folder_.path() / "citymesh.toml";
    std::ofstream(file) << text;
    return file.string();
  }

  /// The settings as `serve` gets them; throws what the command line gets wrong.
  static ServeOptions parsed(std::vector<std::string> words) {
    ServeOptions options;
    CLI::App program{"citymesh"};
    bool called = false;
    add_serve(program, options, [&] { called = true; });
    words.insert(words.begin(), "serve");
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    program.parse(reversed);
    EXPECT_TRUE(called);
    return options;
  }

  TempFolder folder_;
};

TEST_F(ServeSettings, FlagsWinOverTheEnvironmentThatOverTheFileThatOverDefaults) {
  const auto file = config(
      "[serve]\ndata = \"/srv/city\"\nworkers = 2\nmax_open_jobs = 20\nlisten = \"[::1]:81\"\n");
  ServeOptions options = parsed({"--config", file});
  EXPECT_EQ(options.data, "/srv/city");
  EXPECT_EQ(options.workers, 2u);
  EXPECT_EQ(options.max_open_jobs, 20u);
  EXPECT_EQ(to_string(options.listen), "[::1]:81");
  EXPECT_EQ(options.max_watches, ServeOptions{}.max_watches);

  setenv("CITYMESH_WORKERS", "3", 1);
  EXPECT_EQ(parsed({"--config", file}).workers, 3u);
  options = parsed({"--config", file, "--workers", "4"});
  EXPECT_EQ(options.workers, 4u);
  EXPECT_EQ(options.max_open_jobs, 20u);
}

TEST_F(ServeSettings, TheEnvironmentMayNameTheFile) {
  setenv("CITYMESH_CONFIG", config("[serve]\ndata = \"/srv/city\"\n").c_str(), 1);
  EXPECT_EQ(parsed({}).data, "/srv/city");
}

TEST_F(ServeSettings, WhatTheFileGetsWrongIsNamed) {
  const auto message_of = [](const std::vector<std::string>& words) -> std::string {
    try {
      parsed(words);
    } catch (const CLI::Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message_of({"--data", "d", "--config", config("[serve]\ncolour = 1\n")}).find("colour"),
            std::string::npos);
  EXPECT_NE(
      message_of({"--data", "d", "--config", config("[serve]\nworkers = \"many\"\n")}).find("many"),
      std::string::npos);
  EXPECT_NE(message_of({"--data", "d", "--config", "/no/such/file"}).find("/no/such/file"),
            std::string::npos);
}

}  // namespace
}  // namespace citymesh
