#pragma once

#include <chrono>
#include <cstdio>
#include <set>
#include <string>

#include "core/base/run_context.h"

namespace citymesh {

/// Shows how far a run is: one line that is drawn again and again on a terminal, else a plain line
/// per stage and every few seconds.
class ProgressBar {
 public:
  explicit ProgressBar(std::FILE* out);
  ~ProgressBar();  ///< clears the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const Progress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  std::FILE* out_;
  bool terminal_;
  Clock::time_point started_ = Clock::now();
  Clock::time_point shown_{};
  std::set<std::string, std::less<>> stages_{};
};

/// `heal [######....] 120/200 60 %, 412/s`
std::string progress_line(const Progress& progress, double elapsed_s);

}  // namespace citymesh
