#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace citymesh::sqlite {

/// Thrown to the edge of the room that uses a database; as_error() turns it into what callers see.
struct Failure {
  int code = 0;  ///< SQLite's extended result code
  std::string message{};
};

/// `database` names it in the message: "job database".
Error as_error(const Failure& failure, std::string_view database);

/// A prepared statement at work; ready for the next use when it goes.
class Query {
 public:
  explicit Query(sqlite3_stmt* statement) : statement_(statement) {}
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;
  ~Query();

  Query& bind(int index, std::string_view text);
  Query& bind(int index, std::int64_t number);
  Query& bind(int index, std::optional<std::int64_t> number);
  Query& bind(int index, double number);

  bool step();  ///< true: there is a row
  void run() { (void)step(); }

  std::string text(int column) const;            ///< or the bytes of a blob
  std::string_view text_view(int column) const;  ///< the same, until the next step
  double real(int column) const;
  std::int64_t number(int column) const;
  std::optional<std::int64_t> optional_number(int column) const;

 private:
  sqlite3_stmt* statement_;
};

/// One connection; for one thread at a time.
class Connection {
 public:
  explicit Connection(const std::filesystem::path& file);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection();

  void run(const char* sql);            ///< any number of statements without results
  Query query(const char* sql);         ///< prepared once; `sql` must be a literal
  std::int64_t value(const char* sql);  ///< first column of the first row
  int changed_rows() const;

 private:
  void close();

  sqlite3* handle_ = nullptr;
  std::map<std::string_view, sqlite3_stmt*> prepared_;
};

enum class Durability { Full, Relaxed };  ///< on disk at commit; after a power cut perhaps lost

/// Takes the write lock at once; rolled back unless committed.
class Transaction {
 public:
  Transaction(Connection& connection, Durability durability);
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  void commit();

 private:
  Connection& connection_;
  bool open_ = true;
};

}  // namespace citymesh::sqlite
