#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace citymesh {

/// A grid coordinate in metres with exactly 4 decimals: 12345 is "1.2345", -1 is "-0.0001", 0 is
/// "0.0000".
void append_grid(std::string& out, std::int64_t steps);

void append_integer(std::string& out, std::int64_t value);

/// At most `decimals` decimals, no trailing zeros, never "-0"; "null" for what is not finite. The
/// same text everywhere: no locale.
void append_number(std::string& out, double value, int decimals = 6);

/// The shortest text that reads back as the same double; "null" for what is not finite.
void append_exact(std::string& out, double value);

/// Quoted and escaped; bytes that are no UTF-8 become U+FFFD.
void append_json_string(std::string& out, std::string_view text);

/// Escaped for HTML and XML text and attribute values; what XML cannot hold becomes U+FFFD.
void append_markup(std::string& out, std::string_view text);

/// Control characters become spaces: for comments that must stay on their line.
std::string one_line(std::string_view text);

}  // namespace citymesh
