#include "services/citydb/postgres.h"

#include <endian.h>
#include <fmt/format.h>
#include <libpq-fe.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

namespace citymesh::postgres {
namespace {

constexpr int kTick_ms = 50;  // how soon a stop is noticed while the server works
constexpr int kBinary = 1;

template <class Whole>
Whole big_endian(const char* bytes) {
  Whole value;
  std::memcpy(&value, bytes, sizeof value);
  if constexpr (sizeof value == 2) return static_cast<Whole>(be16toh(value));
  if constexpr (sizeof value == 4) return static_cast<Whole>(be32toh(value));
  return static_cast<Whole>(be64toh(value));
}

double double_of(const char* bytes) {
  return std::bit_cast<double>(big_endian<std::uint64_t>(bytes));
}

/// With one blank for every gap.
std::string one_line(const char* text) {
  std::string line;
  for (const char* c = text == nullptr ? "" : text; *c != '\0'; ++c) {
    const bool gap = *c == '\n' || *c == '\t' || *c == ' ';
    if (!gap)
      line += *c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  while (line.ends_with(' ')) line.pop_back();
  return line;
}

/// What the database said, and what an operator can do about it.
Error error_of(const PGresult* result, const Purpose& purpose) {
  const auto* raw = PQresultErrorField(result, PG_DIAG_SQLSTATE);
  const std::string_view state = raw == nullptr ? "" : raw;
  const auto said = one_line(PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY));
  struct Known {
    std::string_view prefix;
    ErrorCode code;
    std::string_view advice;  ///< {0}: flag of the URL, {1}: flag of the schema, {2}: rights
  };
  static constexpr std::array kKnown{
      Known{"57014", ErrorCode::DeadlineExceeded,
            "raise --source_timeout_s, or look for missing indexes and run ANALYZE"},
      Known{"57P", ErrorCode::Unavailable, "the database is being shut down or restarted"},
      Known{"08", ErrorCode::Unavailable, "the connection was lost"},
      Known{"53", ErrorCode::Unavailable, "the database is out of connections, memory or disk"},
      Known{"28", ErrorCode::PermissionDenied, "check user and password of {0}"},
      Known{"42501", ErrorCode::PermissionDenied,
            "GRANT USAGE on the schema and {2} to the user of {0}"},
      Known{"42P01", ErrorCode::FailedPrecondition,
            "the schema is no complete 3DCityDB: check {1}"},
      Known{"42703", ErrorCode::FailedPrecondition,
            "the schema is no 3DCityDB of version 4 or 5: check {1}"},
      Known{"42883", ErrorCode::FailedPrecondition,
            "PostGIS is not installed in this database, or not on its search_path"},
      Known{"3F000", ErrorCode::FailedPrecondition, "check {1}"},
      Known{"25006", ErrorCode::FailedPrecondition,
            "the database or its user is read-only: check {0}"},
      Known{"40", ErrorCode::Unavailable, "somebody else changed the same rows; try again"},
  };
  for (const auto& known : kKnown)
    if (state.starts_with(known.prefix))
      return fail(known.code, fmt::format("the database says: {}; {}", said,
                                          fmt::format(fmt::runtime(known.advice), purpose.url_flag,
                                                      purpose.schema_flag, purpose.rights)));
  return fail(ErrorCode::Internal, fmt::format("the database says: {} (SQLSTATE {})", said, state));
}

}  // namespace

void Rows::Closer::operator()(pg_result* result) const { PQclear(result); }

int Rows::size() const { return PQntuples(result_.get()); }

bool Rows::null(int row, int column) const { return PQgetisnull(result_.get(), row, column) != 0; }

std::int64_t Rows::integer(int row, int column) const {
  const auto bytes = text(row, column);
  switch (bytes.size()) {
    case 1:
      return bytes[0];
    case 2:
      return static_cast<std::int16_t>(big_endian<std::uint16_t>(bytes.data()));
    case 4:
      return static_cast<std::int32_t>(big_endian<std::uint32_t>(bytes.data()));
    case 8:
      return static_cast<std::int64_t>(big_endian<std::uint64_t>(bytes.data()));
    default:
      return 0;
  }
}

double Rows::number(int row, int column) const {
  const auto bytes = text(row, column);
  if (bytes.size() == 8) return double_of(bytes.data());
  if (bytes.size() == 4)
    return static_cast<double>(std::bit_cast<float>(big_endian<std::uint32_t>(bytes.data())));
  return 0;
}

std::string_view Rows::text(int row, int column) const {
  return {PQgetvalue(result_.get(), row, column),
          static_cast<std::size_t>(PQgetlength(result_.get(), row, column))};
}

/// Dimensions, flags and element type, then length and lower bound of the dimension, then length
/// and bytes of each element.
std::vector<double> Rows::numbers(int row, int column) const {
  constexpr std::size_t kHeader = 12, kDimension = 8, kLength = 4;
  auto bytes = text(row, column);
  std::vector<double> values;
  if (bytes.size() < kHeader + kDimension) return values;
  bytes.remove_prefix(kHeader + kDimension);
  while (bytes.size() >= kLength) {
    const auto length = static_cast<std::int32_t>(big_endian<std::uint32_t>(bytes.data()));
    bytes.remove_prefix(kLength);
    const auto size = static_cast<std::size_t>(std::max(length, 0));
    if (bytes.size() < size) break;
    values.push_back(size == sizeof(double) ? double_of(bytes.data()) : 0);
    bytes.remove_prefix(size);
  }
  return values;
}

std::string array_of(std::span<const std::int64_t> numbers) {
  return fmt::format("{{{}}}", fmt::join(numbers, ","));
}

std::string array_of(std::span<const std::string> texts) {
  std::string array = "{";
  for (const auto& text : texts) {
    if (array.size() > 1) array += ',';
    array += '"';
    for (const char c : text) {
      if (c == '"' || c == '\\') array += '\\';
      array += c;
    }
    array += '"';
  }
  return array + '}';
}

Result<std::string> shown_url(const std::string& url) {
  char* problem = nullptr;
  const std::unique_ptr<PQconninfoOption, void (*)(PQconninfoOption*)> parts(
      PQconninfoParse(url.c_str(), &problem), PQconninfoFree);
  PQfreemem(problem);  // it may hold the password
  if (!parts)
    return fail(ErrorCode::InvalidArgument,
                "the address of the database cannot be read, expected "
                "postgresql://user@host:port/database");
  std::string host, port, database;
  for (const auto* part = parts.get(); part->keyword != nullptr; ++part) {
    const std::string_view keyword = part->keyword;
    if (part->val == nullptr) continue;
    if (keyword == "host") host = part->val;
    if (keyword == "port") port = part->val;
    if (keyword == "dbname") database = part->val;
  }
  return fmt::format("postgresql://{}{}{}/{}", host, port.empty() ? "" : ":", port, database);
}

void Connection::Closer::operator()(pg_conn* connection) const { PQfinish(connection); }

Result<Connection> Connection::open(const ConnectionOptions& options) {
  const auto shown = shown_url(options.url);
  if (!shown) return shown.error();
  const auto connect_timeout = std::to_string(options.connect_timeout_s);
  const auto settings =
      fmt::format("-c statement_timeout={}s -c client_encoding=UTF8", options.statement_timeout_s);
  // What comes later counts: the URL is expanded first, our settings cannot be taken back by it.
  const std::array<const char*, 5> keywords{"dbname", "connect_timeout", "application_name",
                                            "options", nullptr};
  const std::array<const char*, 5> values{options.url.c_str(), connect_timeout.c_str(), "citymesh",
                                          settings.c_str(), nullptr};
  Connection connection(PQconnectdbParams(keywords.data(), values.data(), 1), options.purpose);
  auto* raw = connection.connection_.get();
  if (PQstatus(raw) != CONNECTION_OK)
    return fail(PQconnectionNeedsPassword(raw) != 0 || PQconnectionUsedPassword(raw) != 0
                    ? ErrorCode::PermissionDenied
                    : ErrorCode::Unavailable,
                fmt::format("cannot connect to {}: {}", *shown, one_line(PQerrorMessage(raw))));
  PQsetnonblocking(raw, 1);
  return connection;
}

Error Connection::lost() const {
  return fail(ErrorCode::Unavailable, fmt::format("the connection to the database was lost: {}",
                                                  one_line(PQerrorMessage(connection_.get()))));
}

bool Connection::usable() const {
  return !broken_ && PQstatus(connection_.get()) == CONNECTION_OK &&
         PQpipelineStatus(connection_.get()) == PQ_PIPELINE_OFF &&
         PQtransactionStatus(connection_.get()) != PQTRANS_ACTIVE;
}

void Connection::roll_back() {
  if (!usable() || PQtransactionStatus(connection_.get()) == PQTRANS_IDLE) return;
  PQclear(PQexec(connection_.get(), "ROLLBACK"));
}

void Connection::cancel() {
  std::array<char, 256> ignored{};
  auto* cancel = PQgetCancel(connection_.get());
  PQcancel(cancel, ignored.data(), static_cast<int>(ignored.size()));
  PQfreeCancel(cancel);
}

Result<void> Connection::send(const Statement& statement) {
  auto* raw = connection_.get();
  auto known = std::ranges::find(prepared_, statement.sql);
  const auto name = fmt::format("s{}", known - prepared_.begin());
  if (known == prepared_.end()) {
    if (PQsendPrepare(raw, name.c_str(), statement.sql, 0, nullptr) == 0) return lost();
    prepared_.push_back(statement.sql);
  }
  std::vector<const char*> values;
  values.reserve(statement.parameters.size());
  for (const auto& parameter : statement.parameters) values.push_back(parameter.c_str());
  if (PQsendQueryPrepared(raw, name.c_str(), static_cast<int>(values.size()), values.data(),
                          nullptr, nullptr, kBinary) == 0)
    return lost();
  return {};
}

Result<pg_result*> Connection::receive(const std::stop_token& stop) {
  auto* raw = connection_.get();
  bool cancelled = false;
  for (;;) {
    const int unsent = PQflush(raw);
    if (unsent < 0 || PQstatus(raw) != CONNECTION_OK) return lost();
    if (unsent == 0 && PQisBusy(raw) == 0) break;
    if (stop.stop_requested() && !cancelled) {
      cancelled = true;
      cancel();  // the answer is then an error, which ends the waiting
    }
    if (auto waited = wait(unsent == 1); !waited) return waited.error();
  }
  return PQgetResult(raw);
}

Result<void> Connection::wait(bool to_write) {
  auto* raw = connection_.get();
  pollfd socket{PQsocket(raw), static_cast<short>(to_write ? POLLIN | POLLOUT : POLLIN), 0};
  if (poll(&socket, 1, kTick_ms) > 0 && (socket.revents & (POLLIN | POLLERR | POLLHUP)) != 0 &&
      PQconsumeInput(raw) == 0)
    return lost();
  return {};
}

Error Connection::refused(const pg_result* result, const std::stop_token& stop) {
  broken_ = true;  // which of the statements are prepared is not known any more
  if (stop.stop_requested()) return fail(ErrorCode::Cancelled, "stopped while the database worked");
  return error_of(result, purpose_);
}

Result<std::vector<Rows>> Connection::run(std::span<const Statement> statements,
                                          const std::stop_token& stop) {
  auto* raw = connection_.get();
  if (PQenterPipelineMode(raw) == 0) return lost();
  for (const auto& statement : statements)
    if (auto sent = send(statement); !sent) return sent.error();
  if (PQpipelineSync(raw) == 0) return lost();

  std::vector<Rows> answers;
  std::optional<Error> problem;
  for (bool synced = false; !synced;) {
    const auto received = receive(stop);
    if (!received) return received.error();
    if (*received == nullptr) continue;  // between two statements
    Rows answer(*received);
    switch (PQresultStatus(*received)) {
      case PGRES_TUPLES_OK:
        answers.push_back(std::move(answer));
        break;
      case PGRES_PIPELINE_SYNC:
        synced = true;
        break;
      case PGRES_COMMAND_OK:  // prepared
      case PGRES_PIPELINE_ABORTED:
        break;
      default:
        if (!problem) problem = refused(*received, stop);
    }
  }
  if (PQexitPipelineMode(raw) == 0) return lost();
  if (problem) return *problem;
  return answers;
}

Result<Rows> Connection::run(const Statement& statement, const std::stop_token& stop) {
  auto answers = run(std::span(&statement, 1), stop);
  if (!answers) return answers.error();
  if (answers->size() != 1) return fail(ErrorCode::Internal, "a statement gave no rows");
  return std::move(answers->front());
}

Result<void> Connection::copy(const char* sql, std::string_view rows, const std::stop_token& stop) {
  auto* raw = connection_.get();
  if (PQsendQuery(raw, sql) == 0) return lost();
  const auto started = receive(stop);
  if (!started) return started.error();
  const Rows answer(*started);
  if (PQresultStatus(*started) != PGRES_COPY_IN) {
    auto problem = refused(*started, stop);
    while (const auto rest = receive(stop)) {
      if (*rest == nullptr) break;
      PQclear(*rest);
    }
    return problem;
  }
  constexpr std::size_t kPiece = std::size_t{1} << 16;  // what is not sent yet is kept by libpq
  while (!rows.empty()) {
    const auto piece = rows.substr(0, kPiece);
    const int taken = PQputCopyData(raw, piece.data(), static_cast<int>(piece.size()));
    if (taken < 0) return lost();
    if (taken > 0) rows.remove_prefix(piece.size());
    for (int unsent = PQflush(raw); unsent != 0; unsent = PQflush(raw)) {
      if (unsent < 0) return lost();
      if (stop.stop_requested()) cancel();
      if (auto waited = wait(true); !waited) return waited;
    }
  }
  return end_copy(stop);
}

Result<void> Connection::end_copy(const std::stop_token& stop) {
  auto* raw = connection_.get();
  for (int ended = PQputCopyEnd(raw, nullptr); ended != 1; ended = PQputCopyEnd(raw, nullptr)) {
    if (ended < 0) return lost();
    if (auto waited = wait(true); !waited) return waited;
  }
  std::optional<Error> problem;
  for (;;) {
    const auto received = receive(stop);
    if (!received) return received.error();
    if (*received == nullptr) break;
    const Rows answer(*received);
    if (PQresultStatus(*received) != PGRES_COMMAND_OK && !problem)
      problem = refused(*received, stop);
  }
  if (problem) return *problem;
  return {};
}

Result<void> Connection::set_schema(const std::string& schema, const std::stop_token& stop) {
  // Recursions look dear to the planner: compiling them would take longer than running them.
  auto path = run(Statement{"SELECT set_config('search_path', quote_ident($1) || ', ' || "
                            "current_setting('search_path'), false),"
                            " set_config('jit', 'off', false)",
                            {schema}},
                  stop);
  if (!path) return path.error();
  return {};
}

}  // namespace citymesh::postgres
