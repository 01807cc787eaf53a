#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "services/citydb/postgres.h"

namespace citymesh::citydb {

/// The rows of an answer by what they belong to: the first column is the owner's id, the second
/// their order among the rows of that owner.
class RowIndex {
 public:
  explicit RowIndex(const postgres::Rows& rows) {
    struct Key {
      std::int64_t owner = 0, order = 0;
      int row = 0;
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    keys.reserve(static_cast<std::size_t>(rows.size()));
    for (int row = 0; row < rows.size(); ++row)
      keys.push_back({rows.integer(row, 0), rows.integer(row, 1), row});
    std::ranges::sort(keys);
    owners_.reserve(keys.size());
    rows_.reserve(keys.size());
    for (const Key& key : keys) {
      owners_.push_back(key.owner);
      rows_.push_back(key.row);
    }
  }

  std::span<const int> of(std::int64_t owner) const {
    const auto found = std::ranges::equal_range(owners_, owner);
    const auto first = static_cast<std::size_t>(found.begin() - owners_.begin());
    return std::span(rows_).subspan(first, found.size());
  }

 private:
  std::vector<std::int64_t> owners_{};
  std::vector<int> rows_{};
};

}  // namespace citymesh::citydb
