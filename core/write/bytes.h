#pragma once

#include <bit>
#include <cstring>
#include <string>
#include <type_traits>

namespace citymesh {

/// Appends a number as binary formats hold it: little-endian.
template <class Number>
void append_bytes(std::string& bytes, Number value) {
  static_assert(std::is_arithmetic_v<Number> && std::endian::native == std::endian::little);
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace citymesh
