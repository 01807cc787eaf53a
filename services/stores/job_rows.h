#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "services/jobs/job.h"
#include "services/sqlite/sqlite.h"

// The tables of the embedded store and how a job lies in them. All throw sqlite::Failure.

#define CITYMESH_JOB_COLUMNS                                                                      \
  "id, process, inputs, outputs, response_document, state, message, stage, done, total, percent," \
  " error_code, error_message, attempt, dismiss_requested, created, updated, started, finished,"  \
  " results, idempotency_key, owner, subscriber, cache_key, cached"
#define CITYMESH_JOB_FILTER                                                     \
  " FROM job WHERE (?1 = '[]' OR process IN (SELECT value FROM json_each(?1)))" \
  " AND (?2 = '[]' OR state IN (SELECT value FROM json_each(?2)))"

namespace citymesh {

/// Creates the tables of a new database, brings those of an older version up to date, or says why
/// an existing one is not ours.
std::optional<Error> prepare_schema(sqlite::Connection& connection,
                                    const std::filesystem::path& file);

/// Of a row that selects CITYMESH_JOB_COLUMNS.
Job read_job(const sqlite::Query& row);
std::optional<Job> find_job(sqlite::Connection& connection, const std::string& id);
std::optional<Job> find_job_by_key(sqlite::Connection& connection, const std::string& owner,
                                   const std::string& key);
/// The last one that ended and has results.
std::optional<Job> find_job_by_cache_key(sqlite::Connection& connection, const std::string& key);
void insert_job(sqlite::Connection& connection, const Job& job);
/// Stores a changed job; `updated` grows by at least one, so that no watcher misses a change.
void write_job(sqlite::Connection& connection, Job& job);

}  // namespace citymesh
