#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace citymesh::citydb_support {

/// A connection for tests: texts in, texts out.
class Database {
 public:
  /// `url` as libpq takes it: a URL, or keywords and values.
  static Result<Database> open(const std::string& url);
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;
  ~Database();

  /// One statement or many; many are one transaction.
  Result<void> run(const std::string& sql);

  using Row = std::vector<std::optional<std::string>>;
  Result<std::vector<Row>> rows(const std::string& sql);
  /// The only value of the only row; "" for NULL.
  Result<std::string> value(const std::string& sql);

  /// COPY `into` FROM STDIN in text format.
  Result<void> copy(const std::string& into, std::string_view lines);

 private:
  struct Connection;
  explicit Database(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

/// `url` with another database.
Result<std::string> with_database(const std::string& url, const std::string& database);

/// Texts as they stand in SQL: 'it''s', "a name".
std::string literal(std::string_view text);
std::string identifier(std::string_view name);
/// A statement with its parameters $1, $2 … as literals, for what takes none: EXPLAIN, COPY.
std::string with_literals(std::string sql, const std::vector<std::string>& parameters);

}  // namespace citymesh::citydb_support
