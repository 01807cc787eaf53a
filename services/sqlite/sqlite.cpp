#include "services/sqlite/sqlite.h"

#include <fmt/format.h>
#include <sqlite3.h>

namespace citymesh::sqlite {
namespace {

constexpr int kBusyTimeoutMs = 10'000;

[[noreturn]] void raise(sqlite3* handle, int code) {
  if (handle == nullptr) throw Failure{code, sqlite3_errstr(code)};
  throw Failure{sqlite3_extended_errcode(handle), sqlite3_errmsg(handle)};
}

void check(sqlite3_stmt* statement, int code) {
  if (code != SQLITE_OK) raise(sqlite3_db_handle(statement), code);
}

}  // namespace

Error as_error(const Failure& failure, std::string_view database) {
  const auto error = [&](ErrorCode code, std::string_view kind) {
    return fail(code, fmt::format("{}{}: {}", database, kind, failure.message));
  };
  switch (failure.code & 0xff) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_READONLY:
      return error(ErrorCode::Unavailable, "");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return error(ErrorCode::DataLoss, " is damaged");
    case SQLITE_TOOBIG:
    case SQLITE_NOMEM:
      return error(ErrorCode::ResourceExhausted, "");
    default:
      return error(ErrorCode::Internal, fmt::format(" (code {})", failure.code));
  }
}

Query::~Query() {
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
}

Query& Query::bind(int index, std::string_view text) {
  // A null pointer would bind NULL; an empty text is a value.
  check(statement_, sqlite3_bind_text64(statement_, index, text.empty() ? "" : text.data(),
                                        text.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

Query& Query::bind(int index, std::int64_t number) {
  check(statement_, sqlite3_bind_int64(statement_, index, number));
  return *this;
}

Query& Query::bind(int index, std::optional<std::int64_t> number) {
  if (number) return bind(index, *number);
  check(statement_, sqlite3_bind_null(statement_, index));
  return *this;
}

Query& Query::bind(int index, double number) {
  check(statement_, sqlite3_bind_double(statement_, index, number));
  return *this;
}

bool Query::step() {
  const auto code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  raise(sqlite3_db_handle(statement_), code);
}

std::string_view Query::text_view(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_, column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
  return bytes == nullptr ? std::string_view{} : std::string_view(bytes, size);
}

std::string Query::text(int column) const { return std::string(text_view(column)); }

double Query::real(int column) const { return sqlite3_column_double(statement_, column); }

std::int64_t Query::number(int column) const { return sqlite3_column_int64(statement_, column); }

std::optional<std::int64_t> Query::optional_number(int column) const {
  if (sqlite3_column_type(statement_, column) == SQLITE_NULL) return std::nullopt;
  return number(column);
}

Connection::Connection(const std::filesystem::path& file) {
  const auto code =
      sqlite3_open_v2(file.c_str(), &handle_,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  if (code != SQLITE_OK) {
    const Failure failure{code, handle_ != nullptr ? sqlite3_errmsg(handle_) : "out of memory"};
    close();
    throw failure;
  }
  sqlite3_extended_result_codes(handle_, 1);
  sqlite3_busy_timeout(handle_, kBusyTimeoutMs);
}

Connection::~Connection() { close(); }

void Connection::close() {
  for (const auto& [sql, statement] : prepared_) sqlite3_finalize(statement);
  prepared_.clear();
  sqlite3_close(handle_);
  handle_ = nullptr;
}

void Connection::run(const char* sql) {
  const auto code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) raise(handle_, code);
}

Query Connection::query(const char* sql) {
  auto& statement = prepared_[sql];
  if (statement == nullptr) {
    const auto code =
        sqlite3_prepare_v3(handle_, sql, -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
    if (code != SQLITE_OK) raise(handle_, code);
  }
  return Query(statement);
}

std::int64_t Connection::value(const char* sql) {
  auto row = query(sql);
  return row.step() ? row.number(0) : 0;
}

int Connection::changed_rows() const { return sqlite3_changes(handle_); }

Transaction::Transaction(Connection& connection, Durability durability) : connection_(connection) {
  connection_.run(durability == Durability::Full ? "PRAGMA synchronous = FULL"
                                                 : "PRAGMA synchronous = NORMAL");
  connection_.run("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    connection_.run("ROLLBACK");
  } catch (const Failure&) {
    // SQLite has rolled back by itself after a full disk or an I/O error.
  }
}

void Transaction::commit() {
  connection_.run("COMMIT");
  open_ = false;
}

}  // namespace citymesh::sqlite
