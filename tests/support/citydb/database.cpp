#include "tests/support/citydb/database.h"

#include <libpq-fe.h>

#include <utility>

#include "core/base/text.h"

namespace citymesh::citydb_support {
namespace {

using PgResult = std::unique_ptr<PGresult, decltype(&PQclear)>;

std::string quoted(std::string_view text, char quote) {
  std::string all(1, quote);
  for (const char c : text) {
    if (c == quote) all += quote;
    all += c;
  }
  return all + quote;
}

std::string percent_encoded(std::string_view text) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  constexpr std::string_view kPlain = "-_.~/";
  std::string encoded;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       kPlain.find(c) != std::string_view::npos;
    const auto byte = static_cast<unsigned char>(c);
    if (plain)
      encoded += c;
    else
      encoded.append({'%', kHex[byte >> 4], kHex[byte & 15]});
  }
  return encoded;
}

}  // namespace

struct Database::Connection {
  PGconn* pg = nullptr;
  ~Connection() { PQfinish(pg); }

  Error error(std::string_view statement) const {
    return fail(ErrorCode::Internal, std::string(trimmed(PQerrorMessage(pg))) +
                                         " in: " + std::string(statement.substr(0, 500)));
  }
  bool good(const PgResult& result) const {
    const auto status = PQresultStatus(result.get());
    return status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK || status == PGRES_EMPTY_QUERY;
  }
};

Database::Database(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
Database::Database(Database&&) noexcept = default;
Database& Database::operator=(Database&&) noexcept = default;
Database::~Database() = default;

Result<Database> Database::open(const std::string& url) {
  auto connection = std::make_unique<Connection>();
  connection->pg = PQconnectdb(url.c_str());
  if (PQstatus(connection->pg) != CONNECTION_OK)
    return fail(ErrorCode::Unavailable, std::string(trimmed(PQerrorMessage(connection->pg))));
  PQsetNoticeProcessor(
      connection->pg, [](void*, const char*) {}, nullptr);
  return Database(std::move(connection));
}

Result<void> Database::run(const std::string& sql) {
  const PgResult result(PQexec(connection_->pg, sql.c_str()), PQclear);
  if (!connection_->good(result)) return connection_->error(sql);
  return {};
}

Result<std::vector<Database::Row>> Database::rows(const std::string& sql) {
  const PgResult result(PQexec(connection_->pg, sql.c_str()), PQclear);
  if (!connection_->good(result)) return connection_->error(sql);
  std::vector<Row> all(static_cast<std::size_t>(PQntuples(result.get())));
  for (int r = 0; r < PQntuples(result.get()); ++r)
    for (int c = 0; c < PQnfields(result.get()); ++c)
      all[static_cast<std::size_t>(r)].push_back(
          PQgetisnull(result.get(), r, c)
              ? std::optional<std::string>()
              : std::optional<std::string>(PQgetvalue(result.get(), r, c)));
  return all;
}

Result<std::string> Database::value(const std::string& sql) {
  auto all = rows(sql);
  if (!all) return all.error();
  if (all->size() != 1 || all->front().size() != 1)
    return fail(ErrorCode::Internal,
                "expected one value, got " + std::to_string(all->size()) + " rows: " + sql);
  return all->front().front().value_or("");
}

Result<void> Database::copy(const std::string& into, std::string_view lines) {
  const std::string sql = "COPY " + into + " FROM STDIN";
  const PgResult begun(PQexec(connection_->pg, sql.c_str()), PQclear);
  if (PQresultStatus(begun.get()) != PGRES_COPY_IN) return connection_->error(sql);
  constexpr std::size_t kPiece_bytes = 1 << 20;
  for (std::size_t at = 0; at < lines.size(); at += kPiece_bytes) {
    const std::string_view piece = lines.substr(at, kPiece_bytes);
    if (PQputCopyData(connection_->pg, piece.data(), static_cast<int>(piece.size())) != 1)
      return connection_->error(sql);
  }
  if (PQputCopyEnd(connection_->pg, nullptr) != 1) return connection_->error(sql);
  Result<void> outcome;
  for (;;) {
    const PgResult ended(PQgetResult(connection_->pg), PQclear);
    if (!ended) return outcome;
    if (!connection_->good(ended)) outcome = connection_->error(sql);
  }
}

Result<std::string> with_database(const std::string& url, const std::string& database) {
  char* message = nullptr;
  const std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)> options(
      PQconninfoParse(url.c_str(), &message), PQconninfoFree);
  const std::unique_ptr<char, decltype(&PQfreemem)> freed(message, PQfreemem);
  if (!options)
    return fail(ErrorCode::InvalidArgument,
                "no connection string: " + std::string(message ? message : "out of memory"));
  std::string other = "postgresql:///" + percent_encoded(database);
  char separator = '?';
  for (const PQconninfoOption* option = options.get(); option->keyword; ++option) {
    if (!option->val || std::string_view(option->keyword) == "dbname") continue;
    other += std::exchange(separator, '&') + std::string(option->keyword) + "=" +
             percent_encoded(option->val);
  }
  return other;
}

std::string literal(std::string_view text) { return quoted(text, '\''); }
std::string identifier(std::string_view name) { return quoted(name, '"'); }

std::string with_literals(std::string sql, const std::vector<std::string>& parameters) {
  for (std::size_t p = parameters.size(); p > 0; --p) {  // $10 before $1
    const auto name = "$" + std::to_string(p);
    const auto value = literal(parameters[p - 1]);
    for (auto at = sql.find(name); at != std::string::npos; at = sql.find(name, at + value.size()))
      sql.replace(at, name.size(), value);
  }
  return sql;
}

}  // namespace citymesh::citydb_support
