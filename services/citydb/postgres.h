#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

struct pg_conn;
struct pg_result;

namespace citymesh::postgres {

/// The answer of a statement. Values came in binary; a NULL is 0, 0.0 or empty.
class Rows {
 public:
  explicit Rows(pg_result* result) : result_(result) {}

  int size() const;
  bool null(int row, int column) const;
  /// Of smallint, integer, bigint and boolean.
  std::int64_t integer(int row, int column) const;
  /// Of real and double precision.
  double number(int row, int column) const;
  /// Of text types, and the bytes of any other type.
  std::string_view text(int row, int column) const;
  /// Of double precision[]; NULLs in it are 0.
  std::vector<double> numbers(int row, int column) const;

 private:
  struct Closer {
    void operator()(pg_result* result) const;
  };
  std::unique_ptr<pg_result, Closer> result_;
};

/// `sql` is a literal of ours, what comes from outside is among the parameters, as PostgreSQL's
/// text form.
struct Statement {
  const char* sql;
  std::vector<std::string> parameters{};
};

/// "{1,2,3}", the text form of bigint[].
std::string array_of(std::span<const std::int64_t> numbers);
/// "{"a","b"}", the text form of text[].
std::string array_of(std::span<const std::string> texts);

/// What a connection is for, as an operator has to be told when something is missing.
struct Purpose {
  std::string_view url_flag = "--source";
  std::string_view schema_flag = "--source_schema";
  std::string_view rights = "SELECT on its tables";
};

struct ConnectionOptions {
  std::string url{};  ///< postgresql://user@host/database or key=value, as libpq takes it
  int connect_timeout_s = 10;
  int statement_timeout_s = 0;  ///< 0: none
  Purpose purpose{};
};

/// "postgresql://host:port/database": what may be shown of a URL. Errors: InvalidArgument without
/// any part of the URL that could be a password.
Result<std::string> shown_url(const std::string& url);

/// For one thread at a time.
class Connection {
 public:
  /// Errors: Unavailable, PermissionDenied for credentials, InvalidArgument for the URL.
  static Result<Connection> open(const ConnectionOptions& options);

  /// Sends all statements in one go; the answers come in their order. Each is prepared once.
  /// Errors: Cancelled when stopped, Unavailable when the connection is lost, DeadlineExceeded for
  /// the statement timeout, PermissionDenied and FailedPrecondition for what an operator must
  /// change in the database, Internal else. After an error the connection is of no more use.
  Result<std::vector<Rows>> run(std::span<const Statement> statements, const std::stop_token& stop);
  Result<Rows> run(const Statement& statement, const std::stop_token& stop);

  /// Rows in the text form of COPY to the table that `sql`, COPY … FROM STDIN, names. Errors: as of
  /// run().
  Result<void> copy(const char* sql, std::string_view rows, const std::stop_token& stop);

  /// Unqualified names are looked for in this schema first; PostGIS stays in reach, wherever it is
  /// installed.
  Result<void> set_schema(const std::string& schema, const std::stop_token& stop);

  const Purpose& purpose() const { return purpose_; }
  bool usable() const;  ///< neither lost nor in the middle of something
  /// Ends a transaction, if there is one.
  void roll_back();

 private:
  struct Closer {
    void operator()(pg_conn* connection) const;
  };
  Connection(pg_conn* connection, Purpose purpose) : connection_(connection), purpose_(purpose) {}

  Result<void> send(const Statement& statement);
  /// The next answer, waiting for it; null where a statement has no more.
  Result<pg_result*> receive(const std::stop_token& stop);
  /// Waits for the socket, for at most a moment.
  Result<void> wait(bool to_write);
  Result<void> end_copy(const std::stop_token& stop);
  Error refused(const pg_result* result, const std::stop_token& stop);
  void cancel();
  Error lost() const;

  std::unique_ptr<pg_conn, Closer> connection_;
  Purpose purpose_;
  std::vector<const char*> prepared_{};
  bool broken_ = false;
};

}  // namespace citymesh::postgres
