#include "services/stores/job_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

namespace citymesh {
namespace {

using nlohmann::json;
using sqlite::Connection;
using sqlite::Durability;
using sqlite::Query;
using sqlite::Transaction;

constexpr std::int64_t kApplicationId = 0x63'74'6d'73;  // "ctms", in the header of the file

// A task is a job that nobody has finished. `worker` is the last holder and `lease_until` when it
// must have been heard of; a free task has an empty worker, one whose worker died keeps its name.
constexpr const char* kVersion1 = R"sql(
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

constexpr const char* kVersion2 = R"sql(
  ALTER TABLE job ADD COLUMN idempotency_key TEXT NOT NULL DEFAULT '';
  CREATE UNIQUE INDEX job_by_key ON job (idempotency_key) WHERE idempotency_key <> '';
)sql";

// The key of one client says nothing about that of another.
constexpr const char* kVersion3 = R"sql(
  ALTER TABLE job ADD COLUMN owner TEXT NOT NULL DEFAULT '';
  DROP INDEX job_by_key;
  CREATE UNIQUE INDEX job_by_key ON job (owner, idempotency_key) WHERE idempotency_key <> '';
  CREATE INDEX job_by_owner ON job (owner, created DESC);
  CREATE INDEX job_open_by_owner ON job (owner) WHERE state IN ('accepted', 'running');
)sql";

// `callback_due`: when an ended job is to tell its subscriber next; NULL: no more.
constexpr const char* kVersion4 = R"sql(
  ALTER TABLE job ADD COLUMN subscriber TEXT NOT NULL DEFAULT '{}';
  ALTER TABLE job ADD COLUMN callback_attempts INTEGER NOT NULL DEFAULT 0;
  ALTER TABLE job ADD COLUMN callback_due INTEGER;
  CREATE INDEX job_by_callback ON job (callback_due) WHERE callback_due IS NOT NULL;
)sql";

// `cache_key`: only of jobs with results, so that the index stays small.
constexpr const char* kVersion5 = R"sql(
  ALTER TABLE job ADD COLUMN cache_key TEXT NOT NULL DEFAULT '';
  ALTER TABLE job ADD COLUMN cached INTEGER NOT NULL DEFAULT 0;
  CREATE INDEX job_by_cache_key ON job (cache_key, finished) WHERE cache_key <> '';
)sql";

/// Each makes its version out of the one before.
constexpr const char* kSchemas[] = {kVersion1, kVersion2, kVersion3, kVersion4, kVersion5};
constexpr std::int64_t kSchemaVersion = std::size(kSchemas);

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

/// What a request says beside what it wants: whom to tell, and the trace that it belongs to.
std::string context_text(const Job& job) {
  auto context = json::object();
  if (const auto& subscriber = job.spec.subscriber; !subscriber.empty())
    context = {{"success", subscriber.success_uri},
               {"in_progress", subscriber.in_progress_uri},
               {"failed", subscriber.failed_uri},
               {"base", subscriber.base}};
  if (!job.trace_id.empty()) context["trace_id"] = job.trace_id;
  return dump(context);
}

void read_context(const std::string& text, Job& job) {
  const auto stored = json::parse(text);
  job.spec.subscriber = {stored.value("success", ""), stored.value("in_progress", ""),
                         stored.value("failed", ""), stored.value("base", "")};
  job.trace_id = stored.value("trace_id", "");
}

ErrorCode error_code_from(std::string_view name) {
  for (auto code = ErrorCode{}; code != ErrorCode::Internal;
       code = static_cast<ErrorCode>(static_cast<int>(code) + 1))
    if (to_string(code) == name) return code;
  return ErrorCode::Internal;
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
      .bind(20, results_text(job.results))
      .bind(21, job.idempotency_key)
      .bind(22, job.owner)
      .bind(23, context_text(job))
      .bind(24, job.cache_key)
      .bind(25, std::int64_t{job.cached});
}

constexpr const char* kInsertJob =
    "INSERT INTO job (" CITYMESH_JOB_COLUMNS
    ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18,"
    " ?19, ?20, ?21, ?22, ?23, ?24, ?25)";
constexpr const char* kUpdateJob =
    "UPDATE job SET (" CITYMESH_JOB_COLUMNS
    ") = (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19,"
    " ?20, ?21, ?22, ?23, ?24, ?25) WHERE id = ?1";

}  // namespace

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
  job.idempotency_key = row.text(20);
  job.owner = row.text(21);
  read_context(row.text(22), job);
  job.cache_key = row.text(23);
  job.cached = row.number(24) != 0;
  return job;
}

std::optional<Job> find_job(Connection& connection, const std::string& id) {
  auto row = connection.query("SELECT " CITYMESH_JOB_COLUMNS " FROM job WHERE id = ?1");
  row.bind(1, id);
  if (!row.step()) return std::nullopt;
  return read_job(row);
}

std::optional<Job> find_job_by_key(Connection& connection, const std::string& owner,
                                   const std::string& key) {
  if (key.empty()) return std::nullopt;
  auto row = connection.query("SELECT " CITYMESH_JOB_COLUMNS
                              " FROM job WHERE owner = ?1 AND idempotency_key = ?2"
                              " AND idempotency_key <> ''");
  row.bind(1, owner).bind(2, key);
  if (!row.step()) return std::nullopt;
  return read_job(row);
}

std::optional<Job> find_job_by_cache_key(Connection& connection, const std::string& key) {
  auto row = connection.query("SELECT " CITYMESH_JOB_COLUMNS
                              " FROM job WHERE cache_key = ?1 AND cache_key <> ''"
                              " AND state = 'successful' AND results <> '[]'"
                              " ORDER BY finished DESC LIMIT 1");
  row.bind(1, key);
  if (!row.step()) return std::nullopt;
  return read_job(row);
}

void insert_job(Connection& connection, const Job& job) {
  auto query = connection.query(kInsertJob);
  bind_job(query, job);
  query.run();
  const auto& subscriber = job.spec.subscriber;
  if (subscriber.success_uri.empty() && subscriber.failed_uri.empty()) return;
  connection.query("UPDATE job SET callback_due = 0 WHERE id = ?1").bind(1, job.id).run();
}

void write_job(Connection& connection, Job& job) {
  job.updated = std::max(now_ms(), job.updated + 1);
  auto query = connection.query(kUpdateJob);
  bind_job(query, job);
  query.run();
}

std::optional<Error> prepare_schema(Connection& connection, const std::filesystem::path& file) {
  const auto refuse = [&](ErrorCode code, const std::string& why) {
    return fail(code, fmt::format("job database '{}' {}", file.string(), why));
  };
  connection.run("PRAGMA journal_mode = WAL");
  Transaction transaction(connection, Durability::Full);
  const auto application = connection.value("PRAGMA application_id");
  const auto version = connection.value("PRAGMA user_version");
  const auto tables = connection.value("SELECT count(*) FROM sqlite_schema");
  const bool is_new = application == 0 && version == 0 && tables == 0;
  if (!is_new && (application != kApplicationId || version < 1))
    return refuse(ErrorCode::DataLoss, "is not a job database of citymesh");
  if (version > kSchemaVersion)
    return refuse(ErrorCode::FailedPrecondition,
                  fmt::format("has schema version {}, written by a newer citymesh; this one knows "
                              "versions up to {}",
                              version, kSchemaVersion));
  {
    auto findings = connection.query("PRAGMA quick_check(1)");
    if (findings.step() && findings.text(0) != "ok")
      return refuse(ErrorCode::DataLoss,
                    fmt::format("is damaged ({}); move it away to start with an empty one",
                                findings.text(0)));
  }
  if (version == kSchemaVersion) return std::nullopt;
  for (auto next = version; next < kSchemaVersion; ++next) connection.run(kSchemas[next]);
  connection.run(fmt::format("PRAGMA application_id = {}", kApplicationId).c_str());
  connection.run(fmt::format("PRAGMA user_version = {}", kSchemaVersion).c_str());
  transaction.commit();
  return std::nullopt;
}

}  // namespace citymesh
