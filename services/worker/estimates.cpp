#include "services/worker/estimates.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <semaphore>
#include <stop_token>
#include <thread>
#include <utility>

namespace citymesh {
namespace {

constexpr unsigned kMostAtOnce = 64;

/// Asks for a stop when its time is over.
class Deadline {
 public:
  explicit Deadline(TimeMs longest_ms)
      : timer_([this, longest_ms](const std::stop_token& ended) {
          std::unique_lock lock(mutex_);
          if (!wake_.wait_for(lock, ended, std::chrono::milliseconds(longest_ms),
                              [&] { return ended.stop_requested(); }))
            over_.request_stop();
        }) {}

  std::stop_token token() const { return over_.get_token(); }
  bool is_over() const { return over_.stop_requested(); }

 private:
  std::mutex mutex_{};
  std::condition_variable_any wake_{};
  std::stop_source over_{};
  std::jthread timer_;  // last: it uses the others
};

}  // namespace

std::function<Result<Estimate>(const std::string& process, const std::string& inputs_json)>
estimator(SourceFactory open, EstimateLimits limits) {
  limits.at_once = std::min(limits.at_once, kMostAtOnce);
  const auto room = std::make_shared<std::counting_semaphore<kMostAtOnce>>(limits.at_once);
  return [open = std::move(open), room, limits](
             const std::string& process, const std::string& inputs_json) -> Result<Estimate> {
    if (!room->try_acquire())
      return fail(ErrorCode::ResourceExhausted,
                  fmt::format("{} estimates are being made, more than that are not made at a "
                              "time; try again in a moment",
                              limits.at_once));
    struct Leave {
      std::counting_semaphore<kMostAtOnce>& room;
      ~Leave() { room.release(); }
    } const leave{*room};
    const auto source = open();
    if (!source) return source.error();
    const Deadline deadline(limits.longest_ms);
    RunContext context;
    context.stop = deadline.token();
    auto estimated = estimate(process, inputs_json, **source, context);
    if (deadline.is_over())
      return fail(ErrorCode::DeadlineExceeded,
                  fmt::format("the estimate took longer than {} s; choose a smaller `bbox`",
                              static_cast<double>(limits.longest_ms) / 1000));
    return estimated;
  };
}

}  // namespace citymesh
