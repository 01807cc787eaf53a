#include "services/jobs/job_feed.h"

namespace citymesh {

JobFeed::Subscription JobFeed::subscribe(Listener listener) {
  const std::scoped_lock lock(mutex_);
  const auto key = next_key_++;
  listeners_.emplace(key, std::move(listener));
  return {this, key};
}

// The lock is held while listeners run, so that a subscription that has ended is silent for sure.
void JobFeed::publish(const Job& job) {
  const std::scoped_lock lock(mutex_);
  for (const auto& [key, listener] : listeners_) listener(job);
}

void JobFeed::unsubscribe(std::uint64_t key) {
  const std::scoped_lock lock(mutex_);
  listeners_.erase(key);
}

}  // namespace citymesh
