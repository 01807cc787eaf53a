#include "services/apps/signals.h"

#include <pthread.h>
#include <unistd.h>

#include <array>
#include <condition_variable>
#include <csignal>
#include <ctime>
#include <mutex>

namespace citymesh {
namespace {

constexpr int kEndedBySignal = 2;
constexpr timespec kListenInterval{0, 100'000'000};

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

StopOnSignal::StopOnSignal() {
  // Blocked in every thread that is made from here on: only the listener takes them.
  const auto signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // A reader that leaves and a file beyond its limit are errors of that write only.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  listener_ = std::jthread([stop = stop_](const std::stop_token& ended) mutable {
    const auto wanted = stop_signals();
    while (!ended.stop_requested()) {
      if (sigtimedwait(&wanted, nullptr, &kListenInterval) < 0) continue;
      if (!stop.request_stop()) _exit(kEndedBySignal);
    }
  });
}

void StopOnSignal::wait() const {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait(lock, token(), [] { return false; });
}

}  // namespace citymesh
