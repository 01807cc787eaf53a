#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/point.h"
#include "core/source/byte_reader.h"

namespace citymesh::source {

/// A value inside a JSON text, by its place.
struct JsonSlice {
  std::uint64_t begin = 0, end = 0;
  std::uint64_t line = 1;  ///< of `begin`
};

struct JsonMember {
  std::string raw_key{};  ///< between the quotes, escapes as they are
  JsonSlice value{};
};

/// Splits a JSON text too large for memory: finds the members of an object without reading what is
/// in them, and reads long lists of numbers piece by piece. The values are checked by who parses
/// them; here only brackets and quotes are.
class JsonText {
 public:
  JsonText(const RandomReader& file, unsigned max_depth) : file_(file), max_depth_(max_depth) {}

  /// The whole text, without a byte order mark.
  JsonSlice all() const;
  /// Errors: DataLoss naming the line. `members` holds what came before.
  Result<void> members(const JsonSlice& object, std::vector<JsonMember>& members) const;
  /// The values of a list. Errors: DataLoss naming the line. `values` holds what came before.
  Result<void> elements(const JsonSlice& array, std::vector<JsonSlice>& values) const;
  /// [[x, y, z], …]; numbers too large for a double become infinite. Errors: DataLoss.
  Result<void> triples(const JsonSlice& array, std::uint64_t max_count,
                       std::vector<Point3>& triples) const;
  /// Errors: ResourceExhausted above `max_bytes`, DataLoss.
  Result<std::string> text(const JsonSlice& slice, std::uint64_t max_bytes) const;

 private:
  class Cursor;
  const RandomReader& file_;
  unsigned max_depth_;
};

}  // namespace citymesh::source
