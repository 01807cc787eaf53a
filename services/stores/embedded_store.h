#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/jobs/stores.h"

namespace citymesh {

struct EmbeddedStoreOptions {
  std::uint32_t max_attempts = 3;  ///< deaths of a worker after which its job is failed
};

/// Jobs and their queue in one SQLite file. Several processes may share it.
class EmbeddedStore final : public JobStore, public TaskQueue {
 public:
  /// Opens or creates the database. Errors: DataLoss for a file that is damaged or no database of
  /// citymesh, FailedPrecondition for one that a newer version wrote, Unavailable for the disk.
  static Result<std::unique_ptr<EmbeddedStore>> open(const std::filesystem::path& file,
                                                     EmbeddedStoreOptions options = {});
  ~EmbeddedStore() override;

  /// For a process that knows it is the only one: ends all leases and queues again what a killed
  /// process left half done. Returns the number of jobs that were running.
  Result<std::uint64_t> recover();

  Result<void> insert(const Job& job) override;
  Result<Job> get(const std::string& id) override;
  Result<Job> get_by_key(const std::string& owner, const std::string& idempotency_key) override;
  Result<Job> get_by_cache_key(const std::string& cache_key) override;
  Result<std::vector<Job>> list(const JobFilter& filter) override;
  Result<std::uint64_t> count(const JobFilter& filter) override;
  Result<std::uint64_t> count_open() override;
  Result<std::uint64_t> count_open_of(const std::string& owner) override;
  Result<Job> update(const std::string& id, std::optional<std::uint32_t> attempt,
                     const std::function<void(Job&)>& change) override;
  Result<void> set_progress(const std::string& id, std::uint32_t attempt,
                            const JobProgress& progress, std::string_view message,
                            int percent) override;
  Result<void> erase(const std::string& id) override;
  Result<std::vector<Job>> ended_before(TimeMs time, bool with_results,
                                        std::uint32_t limit) override;
  Result<std::uint64_t> result_bytes() override;
  Result<Job> drop_results(const std::string& id, std::string_view message) override;
  Result<std::optional<DueCallback>> take_callback(
      TimeMs now,
      const std::function<std::optional<TimeMs>(std::uint32_t attempt)>& retry_after) override;
  Result<void> callback_done(const std::string& id) override;

  Result<std::optional<Claim>> claim(const std::string& worker, TimeMs lease_ms,
                                     TimeMs wait_ms) override;
  Result<void> heartbeat(const Claim& claim, TimeMs lease_ms) override;
  Result<void> done(const Claim& claim) override;
  Result<void> release(const Claim& claim) override;
  Result<void> remove(const std::string& job_id) override;
  Result<Waiting> waiting() override;

 private:
  struct Connections;
  explicit EmbeddedStore(std::unique_ptr<Connections> connections, EmbeddedStoreOptions options);

  Result<std::optional<Claim>> claim_now(const std::string& worker, TimeMs lease_ms);
  void wake_claimers();

  std::unique_ptr<Connections> connections_;
  EmbeddedStoreOptions options_;
  std::mutex wake_mutex_;
  std::condition_variable wake_;
  std::uint64_t pushes_ = 0;
};

}  // namespace citymesh
