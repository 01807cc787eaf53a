#include "tests/support/citydb/cluster.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace citymesh::citydb_support {
namespace {

// The script leads a session of its own, so that an interrupt from the keyboard does not reach it.
pid_t spawn_script(int input, int output) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  std::string shell = "bash", script = CITYMESH_TEST_CITYDB_FILES "/cluster.sh";
  const std::array<char*, 3> arguments{shell.data(), script.data(), nullptr};
  pid_t child = -1;
  const int failed = ::posix_spawnp(&child, "bash", &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  return failed == 0 ? child : -1;
}

}  // namespace

Result<std::unique_ptr<Cluster>> Cluster::start() {
  std::array<int, 2> commands{}, answers{};
  if (::pipe2(commands.data(), O_CLOEXEC) != 0 || ::pipe2(answers.data(), O_CLOEXEC) != 0)
    return fail(ErrorCode::Internal, "no pipe to the database server of the tests");
  const pid_t child = spawn_script(commands[0], answers[1]);
  ::close(commands[0]);
  ::close(answers[1]);
  auto cluster = std::unique_ptr<Cluster>(new Cluster(child, commands[1], answers[0]));
  if (child < 0) return fail(ErrorCode::Internal, "bash cannot be started");

  const std::string answer = cluster->answer();
  const std::string first = answer.substr(0, answer.find(' '));
  const std::string rest = answer.size() > first.size() ? answer.substr(first.size() + 1) : "";
  if (first == "missing")
    return fail(ErrorCode::Unimplemented,
                "tests with a database need the packages " + rest + " (of Debian 12)");
  if (first != "ready")
    return fail(ErrorCode::Internal,
                "PostgreSQL does not start: " + (rest.empty() ? answer : rest));
  cluster->folder_ = rest;
  return cluster;
}

Cluster::~Cluster() {
  ::close(commands_);  // the sign to clean up
  ::close(answers_);
  if (child_ > 0)
    while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

std::string Cluster::url(std::string_view database) const {
  return "postgresql:///" + std::string(database) + "?host=" + folder_ + "&port=5432&user=citymesh";
}

Result<void> Cluster::restart() {
  if (auto stopped = stop(); !stopped) return stopped;
  return start_again();
}

Result<void> Cluster::tell(const std::string& command) {
  const std::string line = command + "\n";
  if (::write(commands_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    return fail(ErrorCode::Internal, "the database server of the tests is gone");
  const std::string said = answer();
  if (said == "done") return {};
  return fail(ErrorCode::Internal, "PostgreSQL: " + command + ": " + said);
}

std::string Cluster::answer() {
  std::string line;
  for (;;) {
    char c = 0;
    const ssize_t count = ::read(answers_, &c, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0 || c == '\n') return line;
    line += c;
  }
}

}  // namespace citymesh::citydb_support
