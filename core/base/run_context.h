#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>

namespace citymesh {

/// How far a run is. `total` is 0 while it is not known.
struct Progress {
  std::string_view stage;  ///< one of the room names: `source`, `heal`, `write`, `gates` …
  std::uint64_t done = 0;
  std::uint64_t total = 0;  ///< in top-level buildings
};

/// What a run needs from outside. Dismissal, deadline and shutdown all arrive through `stop`.
struct RunContext {
  std::stop_token stop{};
  std::function<void(const Progress&)> on_progress{};  ///< called from one thread at a time
  std::function<double()>
      now_s{};  ///< a monotonic clock for the timings of run.json; none: timings are 0
  unsigned threads = 1;

  bool stopped() const { return stop.stop_requested(); }
  void report(const Progress& progress) const {
    if (on_progress) on_progress(progress);
  }
  double now() const { return now_s ? now_s() : 0.0; }
};

}  // namespace citymesh
