#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace citymesh {

/// The real program as a child process. Its output goes to files, so that nothing blocks.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments);
  /// Through `sh -c "<prelude>; exec citymesh …"`, for limits of the shell.
  Program(const std::string& prelude, std::vector<std::string> arguments);
  ~Program();  ///< kills and waits
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void send(int signal) const;
  int wait();  ///< the exit code; 128 + n when signal n ended it
  bool runs();

  std::string out() const;
  std::string err() const;

 private:
  void start(std::vector<std::string> command);

  std::string folder_;
  pid_t child_ = -1;
  int status_ = 0;
};

}  // namespace citymesh
