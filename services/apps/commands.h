#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "services/apps/arguments.h"
#include "services/config/serve_options.h"

namespace citymesh {

/// Exit codes of the program.
inline constexpr int kDone = 0;
inline constexpr int kDoneWithLosses = 1;  ///< objects dropped, inputs not read, or defects found
inline constexpr int kCouldNotRun = 2;

struct RunArguments {
  std::string process{};
  std::vector<std::filesystem::path> files{};
  std::filesystem::path output{};  ///< empty (for `validate`): the report goes to stdout
  bool overwrite = false;
  unsigned threads = 0;  ///< 0: one per core
  InputArguments inputs{};
};

struct IndexArguments {
  std::filesystem::path data{};
  std::filesystem::path state{};  ///< empty: a hidden folder in `data`
  unsigned threads = 0;           ///< 0: one per core
};

/// Says on stderr what went wrong and returns kCouldNotRun.
int could_not_run(const Error& error);

int run_command(const RunArguments& arguments);
int index_command(const IndexArguments& arguments);
int serve_command(const ServeOptions& options);
/// Prints a new API key on stderr and its line for the file of keys on stdout.
int make_key_command(const std::string& name, const std::string& role);
int processes_command();
int openapi_command(const std::string& server_url);

}  // namespace citymesh
