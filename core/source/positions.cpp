#include "core/source/positions.h"

#include <charconv>
#include <cmath>

namespace citymesh::source {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == ','; }

}  // namespace

PositionsResult append_positions(std::string_view text, unsigned dimension,
                                 std::vector<Point3>& points) {
  const std::size_t before = points.size();
  const char* at = text.data();
  const char* const end = at + text.size();
  double values[3] = {0, 0, 0};
  unsigned filled = 0;

  for (;;) {
    while (at != end && is_blank(*at)) ++at;
    if (at == end) break;
    const char* const start = at;
    if (*at == '+') ++at;  // from_chars takes no plus sign
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    at = stop;
    const bool whole = stop == end || is_blank(*stop);
    if (error != std::errc{} || !whole || !(std::abs(value) <= kMaxCoordinate)) {
      while (at != end && !is_blank(*at)) ++at;
      points.resize(before);
      const std::string_view token(start, static_cast<std::size_t>(at - start));
      if (error == std::errc::result_out_of_range && whole)
        return {PositionsState::OutOfRange, token, 0};
      if (error != std::errc{} || !whole) return {PositionsState::NotANumber, token, 0};
      if (!std::isfinite(value)) return {PositionsState::NonFinite, token, 0};
      return {PositionsState::OutOfRange, token, value};
    }
    values[filled++] = value;
    if (filled == dimension) {
      points.push_back({values[0], values[1], dimension == 3 ? values[2] : 0.0});
      filled = 0;
    }
  }
  if (filled == 0) return {};

  const std::size_t count = (points.size() - before) * dimension + filled;
  points.resize(before);
  if (dimension == 2 && count % 3 == 0) return append_positions(text, 3, points);
  return {PositionsState::WrongCount, {}, static_cast<double>(count)};
}

}  // namespace citymesh::source
