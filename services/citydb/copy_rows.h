#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "services/citydb/postgres.h"

namespace citymesh::citydb {

/// Rows for one table, collected for COPY in its text form: there the columns themselves say what
/// type a value has, which differs between the minor versions of 3DCityDB.
class CopyRows {
 public:
  /// `sql`: a literal, COPY … FROM STDIN.
  explicit CopyRows(const char* sql) : sql_(sql) {}

  // The values of a row in the order of the columns; end() ends it.
  CopyRows& number(std::int64_t value);
  CopyRows& text(std::string_view value);
  CopyRows& null();
  void end();

  std::size_t bytes() const { return lines_.size(); }
  Result<void> send(postgres::Connection& connection, const std::stop_token& stop);

 private:
  void begin_value();

  const char* sql_;
  bool in_row_ = false;
  std::string lines_{};
};

/// Ids from a sequence of the database, drawn many at a time.
class Ids {
 public:
  /// `sql`: nextval for each of $1 rows.
  explicit Ids(const char* sql) : sql_(sql) {}

  /// The next `count` calls of take() have one.
  Result<void> provide(std::size_t count, postgres::Connection& connection,
                       const std::stop_token& stop);
  std::int64_t take() { return ids_[next_++]; }

 private:
  const char* sql_;
  std::vector<std::int64_t> ids_{};
  std::size_t next_ = 0;
};

}  // namespace citymesh::citydb
