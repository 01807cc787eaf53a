#include "tests/integration/apps/program.h"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace citymesh {
namespace {

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

int code_of(int status) {
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

Program::Program(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), CITYMESH_PROGRAM);
  start(std::move(arguments));
}

Program::Program(const std::string& prelude, std::vector<std::string> arguments) {
  std::vector<std::string> command{"/bin/sh", "-c", prelude + "; exec \"$@\"", "sh",
                                   CITYMESH_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  start(std::move(command));
}

void Program::start(std::vector<std::string> command) {
  folder_ = (std::filesystem::temp_directory_path() / "citymesh-program-XXXXXX").string();
  if (mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("cannot create " + folder_);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const auto flags = O_CREAT | O_TRUNC | O_WRONLY;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, (folder_ + "/out").c_str(), flags,
                                   0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, (folder_ + "/err").c_str(), flags,
                                   0600);
  std::vector<char*> argv;
  for (auto& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  const auto error = posix_spawn(&child_, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::system_error(error, std::generic_category(), command[0]);
}

Program::~Program() {
  if (child_ > 0) {
    send(SIGKILL);
    (void)wait();
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void Program::send(int signal) const {
  if (child_ > 0) ::kill(child_, signal);
}

int Program::wait() {
  if (child_ > 0) {
    while (::waitpid(child_, &status_, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
  }
  return code_of(status_);
}

bool Program::runs() {
  if (child_ > 0 && ::waitpid(child_, &status_, WNOHANG) == child_) child_ = -1;
  return child_ > 0;
}

std::string Program::out() const { return content(folder_ + "/out"); }
std::string Program::err() const { return content(folder_ + "/err"); }

}  // namespace citymesh
