#include "tests/support/citydb/copy_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace citymesh::citydb_support {
namespace {

void append_escaped(std::string_view text, std::string& line) {
  for (const char c : text) {
    switch (c) {
      case '\\':
        line += "\\\\";
        break;
      case '\t':
        line += "\\t";
        break;
      case '\n':
        line += "\\n";
        break;
      case '\r':
        line += "\\r";
        break;
      default:
        line += c;
    }
  }
}

}  // namespace

Cell::Cell(std::string_view name, double value) : column(name), text(fmt::format("{}", value)) {}

void CopyTable::add(std::span<const Cell> cells) {
  std::fill(row_.begin(), row_.end(), nullptr);
  std::size_t at = 0;  // cells come in the order of the columns as a rule
  for (const Cell& cell : cells) {
    auto found =
        std::find(columns_.begin() + static_cast<std::ptrdiff_t>(at), columns_.end(), cell.column);
    if (found == columns_.end()) found = std::find(columns_.begin(), columns_.end(), cell.column);
    if (found == columns_.end())
      throw std::logic_error("table " + name_ + " has no column " + std::string(cell.column));
    at = static_cast<std::size_t>(found - columns_.begin());
    row_[at] = &cell;
  }
  for (std::size_t c = 0; c < row_.size(); ++c) {
    if (c > 0) lines_ += '\t';
    if (row_[c] && row_[c]->text)
      append_escaped(*row_[c]->text, lines_);
    else
      lines_ += "\\N";
  }
  lines_ += '\n';
}

Result<void> CopyTable::flush(Database& database) {
  if (lines_.empty()) return {};
  std::string into = name_;
  char separator = '(';
  for (const std::string_view column : columns_) {
    into += separator + std::string(column);
    separator = ',';
  }
  auto copied = database.copy(into + ")", lines_);
  lines_.clear();
  return copied;
}

Result<std::int64_t> CopyTable::next_id(Database& database) const {
  const auto value = database.value("SELECT coalesce(max(id), 0) + 1 FROM " + name_);
  if (!value) return value.error();
  return std::stoll(*value);
}

}  // namespace citymesh::citydb_support
