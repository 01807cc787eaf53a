#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "tests/support/citydb/database.h"

namespace citymesh::citydb_support {

/// A value of a column; NULL by default.
struct Cell {
  std::string_view column{};
  std::optional<std::string> text{};

  Cell(std::string_view name, std::optional<std::string> value)
      : column(name), text(std::move(value)) {}
  Cell(std::string_view name, std::string value) : column(name), text(std::move(value)) {}
  Cell(std::string_view name, const char* value) : column(name), text(value) {}
  Cell(std::string_view name, std::int64_t value) : column(name), text(std::to_string(value)) {}
  Cell(std::string_view name, double value);
};

/// Rows for one table, collected for COPY.
class CopyTable {
 public:
  CopyTable(std::string name, std::vector<std::string_view> columns)
      : name_(std::move(name)), columns_(std::move(columns)), row_(columns_.size()) {}

  /// Columns that are not named are NULL. A column that the table does not have is an exception.
  void add(std::span<const Cell> cells);
  void add(std::initializer_list<Cell> cells) { add(std::span(cells.begin(), cells.size())); }

  std::size_t bytes() const { return lines_.size(); }
  Result<void> flush(Database& database);

  /// The id after the last one in the table.
  Result<std::int64_t> next_id(Database& database) const;

 private:
  std::string name_;
  std::vector<std::string_view> columns_;
  std::vector<const Cell*> row_;
  std::string lines_{};
};

}  // namespace citymesh::citydb_support
