#include "services/citydb/write_back.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/version.h"
#include "core/write/write.h"
#include "services/citydb/postgres.h"
#include "services/citydb/schema.h"
#include "services/citydb/version_writer.h"

namespace citymesh {
namespace {

using namespace citydb;
using postgres::Connection;
using postgres::Statement;

constexpr std::size_t kMostUnsent_bytes = std::size_t{4} << 20;
constexpr std::size_t kBuildingsAtOnce = 1000;  ///< whose earlier versions one statement ends

/// A transaction on the schema that is written to.
struct Session {
  Connection connection;
  Instance instance{};
  const VersionSql* sql = nullptr;
};

Error about_schema(const WriteBackOptions& options, std::string_view what) {
  return fail(ErrorCode::FailedPrecondition,
              fmt::format("schema '{}' of --write_back_schema {}", options.schema, what));
}

Result<Session> begin_session(const WriteBackOptions& options, const std::stop_token& stop) {
  auto opened = Connection::open({.url = options.url,
                                  .connect_timeout_s = options.connect_timeout_s,
                                  .statement_timeout_s = options.statement_timeout_s,
                                  .purpose = {"--write_back_url", "--write_back_schema",
                                              "SELECT, INSERT, UPDATE and DELETE on its tables and "
                                              "USAGE on its sequences"}});
  if (!opened) return opened.error();
  Session session{*std::move(opened)};
  auto& connection = session.connection;
  if (auto chosen = connection.set_schema(options.schema, stop); !chosen) return chosen.error();
  const std::vector<Statement> begin{
      {"BEGIN TRANSACTION ISOLATION LEVEL READ COMMITTED READ WRITE"}};
  if (auto begun = connection.run(begin, stop); !begun) return begun.error();
  auto instance = look_at(connection, options.schema, stop);
  if (!instance) return instance.error();
  session.instance = *std::move(instance);
  session.sql = session.instance.major == 5 ? &sql_v5() : &sql_v4();

  // Names without a schema mean this one as long as its tables cannot go.
  const std::vector<Statement> lock{{session.sql->lock}};
  if (auto locked = connection.run(lock, stop); !locked) return locked.error();
  const auto in_place = connection.run(Statement{session.sql->in_place, {options.schema}}, stop);
  if (!in_place) return in_place.error();
  if (in_place->size() != 1 || in_place->integer(0, 0) == 0)
    return about_schema(options, "lacks tables or sequences of a 3DCityDB");
  return session;
}

/// What is true of jobs that end at the same time: one after the other. `statements` follow.
std::vector<Statement> one_after_another(const WriteBackOptions& options, const VersionSql& sql,
                                         const std::string& lineage) {
  std::vector<Statement> statements{
      {"SELECT pg_advisory_xact_lock(hashtextextended($1, 0))", {"citymesh " + options.schema}}};
  for (const char* statement : sql.withdraw) statements.push_back({statement, {lineage}});
  return statements;
}

class CityDbAttempt final : public WriteBackStore::Attempt {
 public:
  CityDbAttempt(const WriteBackOptions& options, std::string job_id, std::string process,
                std::stop_token stop)
      : options_(options),
        job_id_(std::move(job_id)),
        process_(std::move(process)),
        stop_(std::move(stop)) {}

  Result<void> begin(const Scene& scene) override {
    auto session = begin_session(options_, stop_);
    if (!session) return session.error();
    session_.emplace(*std::move(session));
    const Instance& instance = session_->instance;
    const auto crs = parse_crs(instance.srs_name);
    const auto& id = scene.crs.id;
    if (!crs || (id != crs->id && id.substr(0, id.find('+')) != crs->id))
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("`write_back` needs the coordinates of the database, {}, but the "
                              "result has {}: leave `crs` out, or set it to that of the database",
                              instance.srs_name, id));

    auto& connection = session_->connection;
    const auto now = connection.run(Statement{"SELECT now()::text"}, stop_);
    if (!now) return now.error();
    const auto found = connection.run(Statement{session_->sql->names}, stop_);
    if (!found) return found.error();
    NamedIds names;
    for (int row = 0; row < found->size(); ++row)
      names.emplace(found->text(row, 0), found->integer(row, 1));
    Stamp stamp{.lineage = job_id_,
                .created = std::string(now->text(0, 0)),
                .reason = fmt::format("citymesh {} {}", version(), process_),
                .origin = scene.origin,
                .srid = instance.srid};
    writer_ = instance.major == 5 ? writer_v5(connection, std::move(names), std::move(stamp))
                                  : writer_v4(connection, std::move(names), std::move(stamp));
    return {};
  }

  Result<void> add(const BuildingBodies& building) override {
    if (auto added = writer_->add(building, stop_); !added) return added;
    return writer_->bytes() < kMostUnsent_bytes ? Result<void>{} : writer_->flush(stop_);
  }

  Result<std::vector<std::string>> finish() override {
    if (auto sent = writer_->flush(stop_); !sent) return sent.error();
    std::vector<std::string> warnings;
    if (const auto cavities = writer_->left_out_cavities(); cavities > 0)
      warnings.push_back(fmt::format(
          "write_back: 3DCityDB has no place for interior shells, {} were left out", cavities));
    return warnings;
  }

  Result<void> commit() override {
    auto statements = one_after_another(options_, *session_->sql, job_id_);
    const auto& buildings = writer_->buildings();
    for (std::size_t first = 0; first < buildings.size(); first += kBuildingsAtOnce)
      statements.push_back({session_->sql->supersede,
                            {postgres::array_of(std::span(buildings).subspan(
                                first, std::min(kBuildingsAtOnce, buildings.size() - first)))}});
    if (auto prepared = session_->connection.run(statements, stop_); !prepared)
      return prepared.error();
    const std::vector<Statement> end{{"COMMIT"}};
    if (auto committed = session_->connection.run(end, {}); !committed) return committed.error();
    return {};
  }

 private:
  const WriteBackOptions& options_;
  const std::string job_id_, process_;
  const std::stop_token stop_;
  std::optional<Session> session_{};
  std::unique_ptr<VersionWriter> writer_{};
};

class CityDbWriteBack final : public WriteBackStore {
 public:
  explicit CityDbWriteBack(WriteBackOptions options) : options_(std::move(options)) {}

  std::unique_ptr<Attempt> begin(const std::string& job_id, const std::string& process,
                                 std::stop_token stop) override {
    return std::make_unique<CityDbAttempt>(options_, job_id, process, std::move(stop));
  }

  Result<void> withdraw(const std::string& job_id) override {
    auto session = begin_session(options_, {});
    if (!session) return session.error();
    auto statements = one_after_another(options_, *session->sql, job_id);
    statements.push_back({"COMMIT"});
    if (auto done = session->connection.run(statements, {}); !done) return done.error();
    return {};
  }

 private:
  const WriteBackOptions options_;
};

}  // namespace

std::string citydb::stored_id(const CityObject& object) {
  if (!object.gml_id.empty()) return object.gml_id;
  return "ID_" + (object.body ? object.body->name : std::string());
}

Result<std::unique_ptr<WriteBackStore>> open_write_back(WriteBackOptions options) {
  if (options.schema == options.source_schema)
    return fail(ErrorCode::InvalidArgument,
                fmt::format("--write_back_schema is '{}', the schema that is read; what jobs write "
                            "back goes into another one",
                            options.schema));
  if (auto session = begin_session(options, {}); !session) return session.error();
  return std::unique_ptr<WriteBackStore>(std::make_unique<CityDbWriteBack>(std::move(options)));
}

}  // namespace citymesh
