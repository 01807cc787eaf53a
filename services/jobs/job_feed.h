#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "services/jobs/job.h"

namespace citymesh {

/// Hands every change of a job to those who listen in this process. Thread-safe.
class JobFeed {
 public:
  /// Called on the thread that made the change. Must be quick and must not change jobs.
  using Listener = std::function<void(const Job&)>;

  /// Ends the listening when it goes; after that the listener is not running any more.
  class Subscription {
   public:
    Subscription() = default;
    Subscription(JobFeed* feed, std::uint64_t key) : feed_(feed), key_(key) {}
    Subscription(Subscription&& other) noexcept
        : feed_(std::exchange(other.feed_, nullptr)), key_(other.key_) {}
    Subscription& operator=(Subscription&& other) noexcept {
      std::swap(feed_, other.feed_);
      std::swap(key_, other.key_);
      return *this;
    }
    ~Subscription() {
      if (feed_ != nullptr) feed_->unsubscribe(key_);
    }

   private:
    JobFeed* feed_ = nullptr;
    std::uint64_t key_ = 0;
  };

  /// The feed must outlive the subscription.
  [[nodiscard]] Subscription subscribe(Listener listener);
  void publish(const Job& job);

 private:
  void unsubscribe(std::uint64_t key);

  std::mutex mutex_;
  std::map<std::uint64_t, Listener> listeners_;
  std::uint64_t next_key_ = 0;
};

}  // namespace citymesh
