#include "services/stores/embedded_store.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/sqlite/sqlite.h"

namespace citymesh {
namespace {

using nlohmann::json;
using sqlite::Connection;
using sqlite::Durability;
using sqlite::Failure;
using sqlite::Query;
using sqlite::Transaction;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kApplicationId = 0x63'74'6d'73;  // "ctms", in the header of the file
constexpr std::int64_t kSchemaVersion = 1;
constexpr auto kQueuePoll = std::chrono::milliseconds(200);  // for tasks other processes push

// A task is a job that nobody has finished. `worker` is the last holder and `lease_until` when it
// must have been heard of; a free task has an empty worker, one whose worker died keeps its name.
constexpr const char* kSchema = R"sql(
  CREATE TABLE job (
    id TEXT PRIMARY KEY,
    process TEXT NOT NULL,
    inputs TEXT NOT NULL,
    outputs TEXT NOT NULL,
    response_document INTEGER NOT NULL,
    state TEXT NOT NULL,
    message TEXT NOT NULL,
    stage TEXT NOT NULL,
    done INTEGER NOT NULL,
    total INTEGER NOT NULL,
    percent INTEGER NOT NULL,
    error_code TEXT NOT NULL,
    error_message TEXT NOT NULL,
    attempt INTEGER NOT NULL,
    dismiss_requested INTEGER NOT NULL,
    created INTEGER NOT NULL,
    updated INTEGER NOT NULL,
    started INTEGER,
    finished INTEGER,
    results TEXT NOT NULL
  ) STRICT;
  CREATE INDEX job_by_time ON job (created DESC);
  CREATE INDEX job_open ON job (state) WHERE state IN ('accepted', 'running');
  CREATE TABLE task (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    job_id TEXT NOT NULL UNIQUE REFERENCES job (id) ON DELETE CASCADE,
    worker TEXT NOT NULL DEFAULT '',
    attempt INTEGER NOT NULL DEFAULT 0,
    lease_until INTEGER NOT NULL DEFAULT 0,
    deaths INTEGER NOT NULL DEFAULT 0
  ) STRICT;
)sql";

#define CITYMESH_JOB_COLUMNS                                                                      \
  "id, process, inputs, outputs, response_document, state, message, stage, done, total, percent," \
  " error_code, error_message, attempt, dismiss_requested, created, updated, started, finished,"  \
  " results"
#define CITYMESH_JOB_FILTER                                                     \
  " FROM job WHERE (?1 = '[]' OR process IN (SELECT value FROM json_each(?1)))" \
  " AND (?2 = '[]' OR state IN (SELECT value FROM json_each(?2)))"

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

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string outputs_text(const JobSpec& spec) {
  auto outputs = json::object();
  for (const auto& [output, transmission] : spec.outputs)
    outputs[output] = transmission == Transmission::Value ? "value" : "reference";
  return dump(outputs);
}

std::string results_text(const std::vector<ResultFile>& files) {
  auto results = json::array();
  for (const auto& file : files)
    results.push_back({{"output", file.output},
                       {"file_name", file.file_name},
                       {"media_type", file.media_type},
                       {"bytes", file.bytes}});
  return dump(results);
}

ErrorCode error_code_from(std::string_view name) {
  for (auto code = ErrorCode{}; code != ErrorCode::Internal;
       code = static_cast<ErrorCode>(static_cast<int>(code) + 1))
    if (to_string(code) == name) return code;
  return ErrorCode::Internal;
}

Job read_job(const Query& row) {
  Job job;
  job.id = row.text(0);
  job.spec.process = row.text(1);
  job.spec.inputs_json = row.text(2);
  const auto outputs = json::parse(row.text(3));
  for (const auto& [output, transmission] : outputs.items())
    job.spec.outputs[output] =
        transmission == "value" ? Transmission::Value : Transmission::Reference;
  job.spec.response_document = row.number(4) != 0;
  job.state = job_state_from(row.text(5)).value_or(JobState::Failed);
  job.message = row.text(6);
  job.progress.stage = row.text(7);
  job.progress.done = static_cast<std::uint64_t>(row.number(8));
  job.progress.total = static_cast<std::uint64_t>(row.number(9));
  job.percent = static_cast<int>(row.number(10));
  if (const auto code = row.text(11); !code.empty())
    job.error = Error{error_code_from(code), row.text(12)};
  job.attempt = static_cast<std::uint32_t>(row.number(13));
  job.dismiss_requested = row.number(14) != 0;
  job.created = row.number(15);
  job.updated = row.number(16);
  job.started = row.optional_number(17);
  job.finished = row.optional_number(18);
  const auto results = json::parse(row.text(19));
  for (const auto& file : results)
    job.results.push_back(
        {file.at("output"), file.at("file_name"), file.at("media_type"), file.at("bytes")});
  return job;
}

void bind_job(Query& query, const Job& job) {
  query.bind(1, job.id)
      .bind(2, job.spec.process)
      .bind(3, job.spec.inputs_json)
      .bind(4, outputs_text(job.spec))
      .bind(5, std::int64_t{job.spec.response_document})
      .bind(6, to_string(job.state))
      .bind(7, job.message)
      .bind(8, job.progress.stage)
      .bind(9, static_cast<std::int64_t>(job.progress.done))
      .bind(10, static_cast<std::int64_t>(job.progress.total))
      .bind(11, std::int64_t{job.percent})
      .bind(12, job.error ? to_string(job.error->code) : std::string_view())
      .bind(13, job.error ? std::string_view(job.error->message) : std::string_view())
      .bind(14, std::int64_t{job.attempt})
      .bind(15, std::int64_t{job.dismiss_requested})
      .bind(16, job.created)
      .bind(17, job.updated)
      .bind(18, job.started)
      .bind(19, job.finished)
      .bind(20, results_text(job.results));
}

std::optional<Job> find_job(Connection& connection, const std::string& id) {
  auto row = connection.query("SELECT " CITYMESH_JOB_COLUMNS " FROM job WHERE id = ?1");
  row.bind(1, id);
  if (!row.step()) return std::nullopt;
  return read_job(row);
}

/// Stores a changed job; `updated` grows by at least one, so that no watcher misses a change.
void write_job(Connection& connection, Job& job, const char* verb) {
  job.updated = std::max(now_ms(), job.updated + 1);
  auto query = connection.query(verb);
  bind_job(query, job);
  query.run();
}

constexpr const char* kInsertJob =
    "INSERT INTO job (" CITYMESH_JOB_COLUMNS
    ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18,"
    " ?19, ?20)";
constexpr const char* kUpdateJob =
    "UPDATE job SET (" CITYMESH_JOB_COLUMNS
    ") = (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19,"
    " ?20) WHERE id = ?1";

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
  return {dump(json(filter.processes)), dump(states)};
}

/// Creates the tables of a new database or says why an existing one is not ours.
std::optional<Error> prepare_schema(Connection& connection, const std::filesystem::path& file) {
  const auto refuse = [&](ErrorCode code, const std::string& why) {
    return fail(code, fmt::format("job database '{}' {}", file.string(), why));
  };
  connection.run("PRAGMA journal_mode = WAL");
  Transaction transaction(connection, Durability::Full);
  const auto application = connection.value("PRAGMA application_id");
  const auto version = connection.value("PRAGMA user_version");
  const auto tables = connection.value("SELECT count(*) FROM sqlite_schema");
  if (application == 0 && version == 0 && tables == 0) {
    connection.run(kSchema);
    connection.run(fmt::format("PRAGMA application_id = {}", kApplicationId).c_str());
    connection.run(fmt::format("PRAGMA user_version = {}", kSchemaVersion).c_str());
    transaction.commit();
    return std::nullopt;
  }
  if (application != kApplicationId)
    return refuse(ErrorCode::DataLoss, "is not a job database of citymesh");
  if (version > kSchemaVersion)
    return refuse(ErrorCode::FailedPrecondition,
                  fmt::format("has schema version {}, written by a newer citymesh; this one knows "
                              "versions up to {}",
                              version, kSchemaVersion));
  auto findings = connection.query("PRAGMA quick_check(1)");
  if (findings.step() && findings.text(0) != "ok")
    return refuse(
        ErrorCode::DataLoss,
        fmt::format("is damaged ({}); move it away to start with an empty one", findings.text(0)));
  return std::nullopt;
}

}  // namespace

// Readers do not wait for the disk that a writer waits for.
struct EmbeddedStore::Connections {
  explicit Connections(const std::filesystem::path& file) : writer(file), reader(file) {}

  std::mutex writer_mutex;
  Connection writer;
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
  auto running = guarded([&]() -> Result<std::uint64_t> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Full);
    writer.run("UPDATE task SET lease_until = 0");
    writer.run(
        "INSERT INTO task (job_id) SELECT id FROM job WHERE state IN ('accepted', 'running')"
        " AND id NOT IN (SELECT job_id FROM task) ORDER BY created");
    auto query = writer.query(
        "UPDATE job SET state = 'accepted', message = 'queued again: the server stopped while it"
        " ran', stage = '', done = 0, total = 0, percent = 0, updated = max(updated + 1, ?1)"
        " WHERE state = 'running'");
    query.bind(1, now_ms()).run();
    const auto count = writer.changed_rows();
    transaction.commit();
    return static_cast<std::uint64_t>(count);
  });
  wake_claimers();
  return running;
}

Result<void> EmbeddedStore::insert(const Job& job) {
  auto stored = guarded([&]() -> Result<void> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    if (find_job(writer, job.id))
      return fail(ErrorCode::AlreadyExists, fmt::format("job '{}' exists already", job.id));
    Transaction transaction(writer, Durability::Full);
    {
      auto query = writer.query(kInsertJob);
      bind_job(query, job);
      query.run();
    }
    transaction.commit();
    return {};
  });
  if (stored) changes().publish(job);
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

Result<std::vector<Job>> EmbeddedStore::list(const JobFilter& filter) {
  return guarded([&]() -> Result<std::vector<Job>> {
    const auto [processes, states] = filter_texts(filter);
    const std::scoped_lock lock(connections_->reader_mutex);
    auto rows = connections_->reader.query("SELECT " CITYMESH_JOB_COLUMNS CITYMESH_JOB_FILTER
                                           " ORDER BY created DESC, rowid DESC LIMIT ?3 OFFSET ?4");
    rows.bind(1, processes)
        .bind(2, states)
        .bind(3, std::int64_t{filter.limit})
        .bind(4, std::int64_t{filter.offset});
    std::vector<Job> jobs;
    while (rows.step()) jobs.push_back(read_job(rows));
    return jobs;
  });
}

Result<std::uint64_t> EmbeddedStore::count(const JobFilter& filter) {
  return guarded([&]() -> Result<std::uint64_t> {
    const auto [processes, states] = filter_texts(filter);
    const std::scoped_lock lock(connections_->reader_mutex);
    auto row = connections_->reader.query("SELECT count(*)" CITYMESH_JOB_FILTER);
    row.bind(1, processes).bind(2, states).run();
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

Result<Job> EmbeddedStore::update(const std::string& id, std::optional<std::uint32_t> attempt,
                                  const std::function<void(Job&)>& change) {
  auto updated = guarded([&]() -> Result<Job> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Full);
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
    write_job(writer, *job, kUpdateJob);
    transaction.commit();
    return *std::move(job);
  });
  if (updated) changes().publish(*updated);
  return updated;
}

Result<void> EmbeddedStore::set_progress(const std::string& id, std::uint32_t attempt,
                                         const JobProgress& progress, std::string_view message,
                                         int percent) {
  auto job = guarded([&]() -> Result<Job> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Relaxed);
    auto current = find_job(writer, id);
    if (!current) return no_such_job(id);
    if (current->state != JobState::Running || current->attempt != attempt)
      return fail(ErrorCode::FailedPrecondition,
                  fmt::format("job {}: attempt {} is not running any more", id, attempt));
    current->progress = progress;
    current->message = message;
    current->percent = percent;
    write_job(writer, *current, kUpdateJob);
    transaction.commit();
    return *std::move(current);
  });
  if (!job) return job.error();
  changes().publish(*job);
  return {};
}

Result<void> EmbeddedStore::erase(const std::string& id) {
  return guarded([&]() -> Result<void> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Full);
    writer.query("DELETE FROM job WHERE id = ?1").bind(1, id).run();
    if (writer.changed_rows() == 0) return no_such_job(id);
    transaction.commit();
    return {};
  });
}

Result<void> EmbeddedStore::push(const std::string& job_id) {
  auto pushed = guarded([&]() -> Result<void> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Full);
    if (!find_job(writer, job_id)) return no_such_job(job_id);
    writer.query("INSERT OR IGNORE INTO task (job_id) VALUES (?1)").bind(1, job_id).run();
    transaction.commit();
    return {};
  });
  if (pushed) wake_claimers();
  return pushed;
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
  std::optional<Job> changed;
  auto claimed = guarded([&]() -> Result<std::optional<Claim>> {
    {
      // A look without the write lock: idle workers disturb nobody.
      const std::scoped_lock lock(connections_->reader_mutex);
      auto free = connections_->reader.query("SELECT 1 FROM task WHERE lease_until <= ?1 LIMIT 1");
      if (!free.bind(1, now).step()) return std::optional<Claim>{};
    }
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Full);
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
        write_job(writer, *job, kUpdateJob);
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
          transaction.commit();
          return std::optional(Claim{job_id, job->attempt, worker});
        }
      }
      writer.query("DELETE FROM task WHERE job_id = ?1").bind(1, job_id).run();
      // Closed jobs are told one at a time; the next call goes on.
      if (changed) break;
    }
    transaction.commit();
    return std::optional<Claim>{};
  });
  if (claimed && changed) changes().publish(*changed);
  return claimed;
}

Result<void> EmbeddedStore::heartbeat(const Claim& claim, TimeMs lease_ms) {
  return guarded([&]() -> Result<void> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Relaxed);
    writer
        .query(
            "UPDATE task SET lease_until = ?4 WHERE job_id = ?1 AND worker = ?2 AND attempt = ?3")
        .bind(1, claim.job_id)
        .bind(2, claim.worker)
        .bind(3, std::int64_t{claim.attempt})
        .bind(4, now_ms() + lease_ms)
        .run();
    if (writer.changed_rows() == 0) return lease_lost(claim);
    transaction.commit();
    return {};
  });
}

Result<void> EmbeddedStore::done(const Claim& claim) {
  return guarded([&]() -> Result<void> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Full);
    writer.query("DELETE FROM task WHERE job_id = ?1 AND worker = ?2 AND attempt = ?3")
        .bind(1, claim.job_id)
        .bind(2, claim.worker)
        .bind(3, std::int64_t{claim.attempt})
        .run();
    if (writer.changed_rows() == 0) return lease_lost(claim);
    transaction.commit();
    return {};
  });
}

Result<void> EmbeddedStore::release(const Claim& claim) {
  auto released = guarded([&]() -> Result<void> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Full);
    writer
        .query(
            "UPDATE task SET worker = '', lease_until = 0"
            " WHERE job_id = ?1 AND worker = ?2 AND attempt = ?3")
        .bind(1, claim.job_id)
        .bind(2, claim.worker)
        .bind(3, std::int64_t{claim.attempt})
        .run();
    if (writer.changed_rows() == 0) return lease_lost(claim);
    transaction.commit();
    return {};
  });
  if (released) wake_claimers();
  return released;
}

Result<void> EmbeddedStore::remove(const std::string& job_id) {
  return guarded([&]() -> Result<void> {
    const std::scoped_lock lock(connections_->writer_mutex);
    auto& writer = connections_->writer;
    Transaction transaction(writer, Durability::Full);
    writer.query("DELETE FROM task WHERE job_id = ?1").bind(1, job_id).run();
    transaction.commit();
    return {};
  });
}

Result<std::uint64_t> EmbeddedStore::waiting() {
  return guarded([&]() -> Result<std::uint64_t> {
    const std::scoped_lock lock(connections_->reader_mutex);
    auto row = connections_->reader.query("SELECT count(*) FROM task WHERE lease_until <= ?1");
    row.bind(1, now_ms()).run();
    return static_cast<std::uint64_t>(row.number(0));
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
