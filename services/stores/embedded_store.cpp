#include "services/stores/embedded_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "services/sqlite/group_commit.h"
#include "services/sqlite/sqlite.h"
#include "services/stores/job_rows.h"

namespace citymesh {
namespace {

using nlohmann::json;
using sqlite::Connection;
using sqlite::Durability;
using sqlite::Failure;
using Clock = std::chrono::steady_clock;

constexpr auto kQueuePoll = std::chrono::milliseconds(200);  // for tasks of other processes

constexpr std::string_view kDatabase = "job database";

/// Runs `work`, which returns a Result or throws Failure.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const Failure& failure) {
    return as_error(failure, kDatabase);
  } catch (const json::exception& error) {
    return fail(ErrorCode::DataLoss,
                fmt::format("job database holds an unreadable job: {}", error.what()));
  }
}

Error no_such_job(const std::string& id) {
  return fail(ErrorCode::NotFound, fmt::format("job '{}' does not exist", id));
}

Error lease_lost(const Claim& claim) {
  return fail(ErrorCode::FailedPrecondition,
              fmt::format("job {}: attempt {} of {} no longer holds the lease", claim.job_id,
                          claim.attempt, claim.worker));
}

std::pair<std::string, std::string> filter_texts(const JobFilter& filter) {
  auto states = json::array();
  for (const auto state : filter.states) states.push_back(to_string(state));
  return {json(filter.processes).dump(-1, ' ', false, json::error_handler_t::replace),
          states.dump()};
}

// An owner's jobs by a statement of their own, so that the index over owners serves it.
#define OF_OWNER " AND owner = ?3"
#define NEWEST_FIRST " ORDER BY created DESC, rowid DESC LIMIT ?4 OFFSET ?5"
constexpr const char* kList = "SELECT " CITYMESH_JOB_COLUMNS CITYMESH_JOB_FILTER NEWEST_FIRST;
constexpr const char* kListOfOwner =
    "SELECT " CITYMESH_JOB_COLUMNS CITYMESH_JOB_FILTER OF_OWNER NEWEST_FIRST;
constexpr const char* kCount = "SELECT count(*)" CITYMESH_JOB_FILTER;
constexpr const char* kCountOfOwner = "SELECT count(*)" CITYMESH_JOB_FILTER OF_OWNER;

void bind_owner(sqlite::Query& query, const JobFilter& filter) {
  if (filter.owner) query.bind(3, *filter.owner);
}

}  // namespace

// Readers do not wait for the disk that a writer waits for.
struct EmbeddedStore::Connections {
  explicit Connections(const std::filesystem::path& file) : writer(file), reader(file) {}

  /// `work(writer)` returns a Result; of an error nothing stays.
  template <class Work>
  std::invoke_result_t<Work, Connection&> write(Durability durability, const Work& work) {
    return guarded([&] {
      std::optional<std::invoke_result_t<Work, Connection&>> result;
      commits.write(durability, [&] {
        result.emplace(work(writer));
        return static_cast<bool>(*result);
      });
      return *std::move(result);
    });
  }

  Connection writer;
  sqlite::GroupCommit commits{writer};
  std::mutex reader_mutex;
  Connection reader;
};

EmbeddedStore::EmbeddedStore(std::unique_ptr<Connections> connections, EmbeddedStoreOptions options)
    : connections_(std::move(connections)), options_(options) {}

EmbeddedStore::~EmbeddedStore() = default;

Result<std::unique_ptr<EmbeddedStore>> EmbeddedStore::open(const std::filesystem::path& file,
                                                           EmbeddedStoreOptions options) {
  try {
    auto connections = std::make_unique<Connections>(file);
    connections->writer.run("PRAGMA foreign_keys = ON");
    if (auto refused = prepare_schema(connections->writer, file)) return *refused;
    connections->reader.run("PRAGMA query_only = ON");
    return std::unique_ptr<EmbeddedStore>(new EmbeddedStore(std::move(connections), options));
  } catch (const Failure& failure) {
    auto error = as_error(failure, kDatabase);
    error.message = fmt::format("cannot open '{}': {}", file.string(), error.message);
    return error;
  }
}

Result<std::uint64_t> EmbeddedStore::recover() {
  auto running =
      connections_->write(Durability::Full, [&](Connection& writer) -> Result<std::uint64_t> {
        writer.run("UPDATE task SET lease_until = 0");
        writer.run(
            "INSERT INTO task (job_id) SELECT id FROM job WHERE state IN ('accepted', 'running')"
            " AND id NOT IN (SELECT job_id FROM task) ORDER BY created");
        auto query = writer.query(
            "UPDATE job SET state = 'accepted', message = 'queued again: the server stopped while "
            "it"
            " ran', stage = '', done = 0, total = 0, percent = 0, updated = max(updated + 1, ?1)"
            " WHERE state = 'running'");
        query.bind(1, now_ms()).run();
        const auto count = writer.changed_rows();
        return static_cast<std::uint64_t>(count);
      });
  wake_claimers();
  return running;
}

Result<void> EmbeddedStore::insert(const Job& job) {
  auto stored = connections_->write(Durability::Full, [&](Connection& writer) -> Result<void> {
    if (find_job(writer, job.id))
      return fail(ErrorCode::AlreadyExists, fmt::format("job '{}' exists already", job.id));
    if (find_job_by_key(writer, job.owner, job.idempotency_key))
      return fail(
          ErrorCode::AlreadyExists,
          fmt::format("a job with idempotency key '{}' exists already", job.idempotency_key));
    insert_job(writer, job);
    if (!is_final(job.state))
      writer.query("INSERT INTO task (job_id) VALUES (?1)").bind(1, job.id).run();
    return {};
  });
  if (!stored) return stored;
  changes().publish(job);
  wake_claimers();
  return stored;
}

Result<Job> EmbeddedStore::get(const std::string& id) {
  return guarded([&]() -> Result<Job> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto job = find_job(connections_->reader, id);
    if (!job) return no_such_job(id);
    return *std::move(job);
  });
}

Result<Job> EmbeddedStore::get_by_key(const std::string& owner,
                                      const std::string& idempotency_key) {
  return guarded([&]() -> Result<Job> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto job = find_job_by_key(connections_->reader, owner, idempotency_key);
    if (!job)
      return fail(ErrorCode::NotFound,
                  fmt::format("no job has the idempotency key '{}'", idempotency_key));
    return *std::move(job);
  });
}

Result<Job> EmbeddedStore::get_by_cache_key(const std::string& cache_key) {
  return guarded([&]() -> Result<Job> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto job = find_job_by_cache_key(connections_->reader, cache_key);
    if (!job)
      return fail(ErrorCode::NotFound, fmt::format("no results are kept under '{}'", cache_key));
    return *std::move(job);
  });
}

Result<std::vector<Job>> EmbeddedStore::list(const JobFilter& filter) {
  return guarded([&]() -> Result<std::vector<Job>> {
    const auto [processes, states] = filter_texts(filter);
    const std::scoped_lock lock(connections_->reader_mutex);
    auto rows = connections_->reader.query(filter.owner ? kListOfOwner : kList);
    rows.bind(1, processes)
        .bind(2, states)
        .bind(4, std::int64_t{filter.limit})
        .bind(5, std::int64_t{filter.offset});
    bind_owner(rows, filter);
    std::vector<Job> jobs;
    while (rows.step()) jobs.push_back(read_job(rows));
    return jobs;
  });
}

Result<std::vector<Job>> EmbeddedStore::ended_before(TimeMs time, bool with_results,
                                                     std::uint32_t limit) {
  return guarded([&]() -> Result<std::vector<Job>> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto rows = connections_->reader.query(
        "SELECT " CITYMESH_JOB_COLUMNS
        " FROM job WHERE finished < ?1 AND state NOT IN ('accepted', 'running')"
        " AND (NOT ?2 OR results <> '[]') ORDER BY finished, rowid LIMIT ?3");
    rows.bind(1, time).bind(2, std::int64_t{with_results}).bind(3, std::int64_t{limit});
    std::vector<Job> jobs;
    while (rows.step()) jobs.push_back(read_job(rows));
    return jobs;
  });
}

Result<std::uint64_t> EmbeddedStore::result_bytes() {
  return guarded([&]() -> Result<std::uint64_t> {
    const std::scoped_lock lock(connections_->reader_mutex);
    return static_cast<std::uint64_t>(
        connections_->reader.value("SELECT ifnull(sum(json_extract(file.value, '$.bytes')), 0)"
                                   " FROM job, json_each(job.results) AS file"));
  });
}

Result<Job> EmbeddedStore::drop_results(const std::string& id, std::string_view message) {
  auto dropped = connections_->write(Durability::Full, [&](Connection& writer) -> Result<Job> {
    auto job = find_job(writer, id);
    if (!job) return no_such_job(id);
    if (!is_final(job->state))
      return fail(
          ErrorCode::FailedPrecondition,
          fmt::format("job {} is {}, expected one that has ended", id, to_string(job->state)));
    job->results.clear();
    job->cache_key.clear();
    job->message = message;
    write_job(writer, *job);
    return *std::move(job);
  });
  if (dropped) changes().publish(*dropped);
  return dropped;
}

Result<std::optional<JobStore::DueCallback>> EmbeddedStore::take_callback(
    TimeMs now, const std::function<std::optional<TimeMs>(std::uint32_t attempt)>& retry_after) {
  constexpr auto* kDue =
      "SELECT id, callback_attempts FROM job WHERE callback_due <= ?1"
      " AND state NOT IN ('accepted', 'running') ORDER BY callback_due LIMIT 1";
  // Mostly there is none: no need to keep others from writing.
  const auto any = guarded([&]() -> Result<bool> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto row = connections_->reader.query(kDue);
    row.bind(1, now);
    return row.step();
  });
  if (!any) return any.error();
  if (!*any) return std::optional<DueCallback>{};
  return connections_->write(
      Durability::Full, [&](Connection& writer) -> Result<std::optional<DueCallback>> {
        DueCallback due;
        {
          auto row = writer.query(kDue);
          row.bind(1, now);
          if (!row.step()) return std::optional<DueCallback>{};
          due.attempt = static_cast<std::uint32_t>(row.number(1)) + 1;
          due.job = find_job(writer, row.text(0)).value_or(Job{});
        }
        const auto wait = retry_after(due.attempt);
        writer.query("UPDATE job SET callback_attempts = ?2, callback_due = ?3 WHERE id = ?1")
            .bind(1, due.job.id)
            .bind(2, std::int64_t{due.attempt})
            .bind(3, wait ? std::optional<TimeMs>(now + *wait) : std::nullopt)
            .run();
        return std::optional(std::move(due));
      });
}

Result<void> EmbeddedStore::callback_done(const std::string& id) {
  return connections_->write(Durability::Full, [&](Connection& writer) -> Result<void> {
    writer.query("UPDATE job SET callback_due = NULL WHERE id = ?1").bind(1, id).run();
    return {};
  });
}

Result<std::uint64_t> EmbeddedStore::count(const JobFilter& filter) {
  return guarded([&]() -> Result<std::uint64_t> {
    const auto [processes, states] = filter_texts(filter);
    const std::scoped_lock lock(connections_->reader_mutex);
    auto row = connections_->reader.query(filter.owner ? kCountOfOwner : kCount);
    row.bind(1, processes).bind(2, states);
    bind_owner(row, filter);
    row.run();
    return static_cast<std::uint64_t>(row.number(0));
  });
}

Result<std::uint64_t> EmbeddedStore::count_open() {
  return guarded([&]() -> Result<std::uint64_t> {
    const std::scoped_lock lock(connections_->reader_mutex);
    return static_cast<std::uint64_t>(connections_->reader.value(
        "SELECT count(*) FROM job WHERE state IN ('accepted', 'running')"));
  });
}

Result<std::uint64_t> EmbeddedStore::count_open_of(const std::string& owner) {
  return guarded([&]() -> Result<std::uint64_t> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto row = connections_->reader.query(
        "SELECT count(*) FROM job WHERE owner = ?1 AND state IN ('accepted', 'running')");
    row.bind(1, owner).run();
    return static_cast<std::uint64_t>(row.number(0));
  });
}

Result<Job> EmbeddedStore::update(const std::string& id, std::optional<std::uint32_t> attempt,
                                  const std::function<void(Job&)>& change) {
  auto updated = connections_->write(Durability::Full, [&](Connection& writer) -> Result<Job> {
    auto job = find_job(writer, id);
    if (!job) return no_such_job(id);
    if (is_final(job->state))
      return fail(ErrorCode::FailedPrecondition,
                  fmt::format("job {} is {} and stays so", id, to_string(job->state)));
    if (attempt && *attempt != job->attempt)
      return fail(ErrorCode::FailedPrecondition,
                  fmt::format("job {}: attempt {} is over, attempt {} has taken its place", id,
                              *attempt, job->attempt));
    change(*job);
    job->id = id;
    write_job(writer, *job);
    return *std::move(job);
  });
  if (updated) changes().publish(*updated);
  return updated;
}

Result<void> EmbeddedStore::set_progress(const std::string& id, std::uint32_t attempt,
                                         const JobProgress& progress, std::string_view message,
                                         int percent) {
  auto job = connections_->write(Durability::Relaxed, [&](Connection& writer) -> Result<Job> {
    auto current = find_job(writer, id);
    if (!current) return no_such_job(id);
    if (current->state != JobState::Running || current->attempt != attempt)
      return fail(ErrorCode::FailedPrecondition,
                  fmt::format("job {}: attempt {} is not running any more", id, attempt));
    current->progress = progress;
    current->message = message;
    current->percent = percent;
    write_job(writer, *current);
    return *std::move(current);
  });
  if (!job) return job.error();
  changes().publish(*job);
  return {};
}

Result<void> EmbeddedStore::erase(const std::string& id) {
  return connections_->write(Durability::Full, [&](Connection& writer) -> Result<void> {
    writer.query("DELETE FROM job WHERE id = ?1").bind(1, id).run();
    if (writer.changed_rows() == 0) return no_such_job(id);
    return {};
  });
}

Result<std::optional<Claim>> EmbeddedStore::claim(const std::string& worker, TimeMs lease_ms,
                                                  TimeMs wait_ms) {
  const auto deadline = Clock::now() + std::chrono::milliseconds(wait_ms);
  for (;;) {
    std::uint64_t seen = 0;
    {
      const std::scoped_lock lock(wake_mutex_);
      seen = pushes_;
    }
    auto claimed = claim_now(worker, lease_ms);
    if (!claimed || *claimed) return claimed;
    const auto now = Clock::now();
    if (now >= deadline) return claimed;
    std::unique_lock lock(wake_mutex_);
    wake_.wait_until(lock, std::min(deadline, now + kQueuePoll), [&] { return pushes_ != seen; });
  }
}

Result<std::optional<Claim>> EmbeddedStore::claim_now(const std::string& worker, TimeMs lease_ms) {
  const auto now = now_ms();
  // A look without the write lock: idle workers disturb nobody.
  const auto some = guarded([&]() -> Result<bool> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto free = connections_->reader.query("SELECT 1 FROM task WHERE lease_until <= ?1 LIMIT 1");
    return free.bind(1, now).step();
  });
  if (!some) return some.error();
  if (!*some) return std::optional<Claim>{};

  std::optional<Job> changed;
  using Claimed = Result<std::optional<Claim>>;
  auto claimed = connections_->write(Durability::Full, [&](Connection& writer) -> Claimed {
    for (;;) {
      std::string job_id;
      std::int64_t deaths = 0;
      {
        auto task = writer.query(
            "SELECT job_id, deaths + (worker <> '') FROM task WHERE lease_until <= ?1"
            " ORDER BY seq LIMIT 1");
        if (!task.bind(1, now).step()) break;
        job_id = task.text(0);
        deaths = task.number(1);
      }
      auto job = find_job(writer, job_id);
      if (job && !is_final(job->state)) {
        if (job->dismiss_requested) {
          job->state = JobState::Dismissed;
          job->message = "dismissed";
          job->finished = now;
        } else if (deaths >= std::int64_t{options_.max_attempts}) {
          job->state = JobState::Failed;
          job->message =
              deaths == 1 ? "the worker died once while running this job"
                          : fmt::format("the worker died {} times while running this job", deaths);
          job->error = fail(ErrorCode::Internal, job->message);
          job->finished = now;
        } else {
          ++job->attempt;
        }
        write_job(writer, *job);
        changed = job;
        if (!is_final(job->state)) {
          writer
              .query(
                  "UPDATE task SET worker = ?2, attempt = ?3, lease_until = ?4, deaths = ?5"
                  " WHERE job_id = ?1")
              .bind(1, job_id)
              .bind(2, worker)
              .bind(3, std::int64_t{job->attempt})
              .bind(4, now + lease_ms)
              .bind(5, deaths)
              .run();
          return std::optional(Claim{job_id, job->attempt, worker});
        }
      }
      writer.query("DELETE FROM task WHERE job_id = ?1").bind(1, job_id).run();
      // Closed jobs are told one at a time; the next call goes on.
      if (changed) break;
    }
    return std::optional<Claim>{};
  });
  if (claimed && changed) changes().publish(*changed);
  return claimed;
}

Result<void> EmbeddedStore::heartbeat(const Claim& claim, TimeMs lease_ms) {
  return connections_->write(Durability::Relaxed, [&](Connection& writer) -> Result<void> {
    writer
        .query(
            "UPDATE task SET lease_until = ?4 WHERE job_id = ?1 AND worker = ?2 AND attempt = ?3")
        .bind(1, claim.job_id)
        .bind(2, claim.worker)
        .bind(3, std::int64_t{claim.attempt})
        .bind(4, now_ms() + lease_ms)
        .run();
    if (writer.changed_rows() == 0) return lease_lost(claim);
    return {};
  });
}

Result<void> EmbeddedStore::done(const Claim& claim) {
  return connections_->write(Durability::Full, [&](Connection& writer) -> Result<void> {
    writer.query("DELETE FROM task WHERE job_id = ?1 AND worker = ?2 AND attempt = ?3")
        .bind(1, claim.job_id)
        .bind(2, claim.worker)
        .bind(3, std::int64_t{claim.attempt})
        .run();
    if (writer.changed_rows() == 0) return lease_lost(claim);
    return {};
  });
}

Result<void> EmbeddedStore::release(const Claim& claim) {
  auto released = connections_->write(Durability::Full, [&](Connection& writer) -> Result<void> {
    writer
        .query(
            "UPDATE task SET worker = '', lease_until = 0"
            " WHERE job_id = ?1 AND worker = ?2 AND attempt = ?3")
        .bind(1, claim.job_id)
        .bind(2, claim.worker)
        .bind(3, std::int64_t{claim.attempt})
        .run();
    if (writer.changed_rows() == 0) return lease_lost(claim);
    return {};
  });
  if (released) wake_claimers();
  return released;
}

Result<void> EmbeddedStore::remove(const std::string& job_id) {
  return connections_->write(Durability::Full, [&](Connection& writer) -> Result<void> {
    writer.query("DELETE FROM task WHERE job_id = ?1").bind(1, job_id).run();
    return {};
  });
}

Result<TaskQueue::Waiting> EmbeddedStore::waiting() {
  return guarded([&]() -> Result<Waiting> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto row = connections_->reader.query(
        "SELECT count(*), ifnull(min(created), 0) FROM task JOIN job ON job.id = task.job_id"
        " WHERE lease_until <= ?1");
    row.bind(1, now_ms()).run();
    return Waiting{static_cast<std::uint64_t>(row.number(0)), row.number(1)};
  });
}

void EmbeddedStore::wake_claimers() {
  {
    const std::scoped_lock lock(wake_mutex_);
    ++pushes_;
  }
  wake_.notify_all();
}

}  // namespace citymesh
