#pragma once

#include <stop_token>
#include <thread>

namespace citymesh {

/// Turns the first SIGINT or SIGTERM into a stop request and the second one into an immediate end
/// with exit code 2. To be made before any other thread.
class StopOnSignal {
 public:
  StopOnSignal();

  std::stop_token token() const { return stop_.get_token(); }
  void wait() const;  ///< until the first signal

 private:
  std::stop_source stop_;
  std::jthread listener_;
};

}  // namespace citymesh
