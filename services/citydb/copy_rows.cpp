#include "services/citydb/copy_rows.h"

#include <algorithm>

namespace citymesh::citydb {

void CopyRows::begin_value() {
  if (in_row_) lines_ += '\t';
  in_row_ = true;
}

CopyRows& CopyRows::number(std::int64_t value) {
  begin_value();
  lines_ += std::to_string(value);
  return *this;
}

/// A text of PostgreSQL holds no NUL: it ends there.
CopyRows& CopyRows::text(std::string_view value) {
  begin_value();
  for (const char c : value.substr(0, value.find('\0'))) {
    switch (c) {
      case '\\':
        lines_ += "\\\\";
        break;
      case '\t':
        lines_ += "\\t";
        break;
      case '\n':
        lines_ += "\\n";
        break;
      case '\r':
        lines_ += "\\r";
        break;
      default:
        lines_ += c;
    }
  }
  return *this;
}

CopyRows& CopyRows::null() {
  begin_value();
  lines_ += "\\N";
  return *this;
}

void CopyRows::end() {
  lines_ += '\n';
  in_row_ = false;
}

Result<void> CopyRows::send(postgres::Connection& connection, const std::stop_token& stop) {
  if (lines_.empty()) return {};
  auto sent = connection.copy(sql_, lines_, stop);
  lines_.clear();
  return sent;
}

Result<void> Ids::provide(std::size_t count, postgres::Connection& connection,
                          const std::stop_token& stop) {
  constexpr std::size_t kAtOnce = 1000;
  const std::size_t left = ids_.size() - next_;
  if (left >= count) return {};
  ids_.erase(ids_.begin(), ids_.begin() + static_cast<std::ptrdiff_t>(next_));
  next_ = 0;
  const auto drawn = connection.run(
      postgres::Statement{sql_, {std::to_string(std::max(kAtOnce, count - left))}}, stop);
  if (!drawn) return drawn.error();
  ids_.reserve(ids_.size() + static_cast<std::size_t>(drawn->size()));
  for (int row = 0; row < drawn->size(); ++row) ids_.push_back(drawn->integer(row, 0));
  return {};
}

}  // namespace citymesh::citydb
