#pragma once

#include <string_view>
#include <vector>

#include "core/geometry/point.h"

namespace citymesh::source {

/// What reading a list of coordinates found first.
enum class PositionsState { Ok, NotANumber, WrongCount, NonFinite, OutOfRange };

struct PositionsResult {
  PositionsState state = PositionsState::Ok;
  std::string_view token{};  ///< the offending text
  double value = 0;
};

/// No coordinate of any CRS in metres, feet or degrees is larger.
inline constexpr double kMaxCoordinate = 1e8;

/// Appends the coordinates of a gml:posList, pos or coordinates (commas count as blanks). With two
/// dimensions z is 0. A list of two-dimensional context whose count only fits three is read as
/// three. After a defect nothing is appended.
PositionsResult append_positions(std::string_view text, unsigned dimension,
                                 std::vector<Point3>& points);

}  // namespace citymesh::source
