#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/citymodel/issue.h"
#include "core/geometry/point.h"

namespace citymesh {

/// Collects issues in the order in which they are found. Of each code the first ones are placed,
/// the others only counted: a last issue of the code says how many.
class Findings {
 public:
  static constexpr std::size_t kMaxPlaces = 100;  ///< of each code

  /// `where` makes the text; it is not called for what is only counted.
  template <class Where>
  void add(int code, Where&& where, double measured, std::optional<Point3> at) {
    if (++counts_[code] <= kMaxPlaces) issues_.push_back({code, where(), measured, at});
  }

  std::size_t count() const;
  std::vector<Issue> take();

 private:
  std::vector<Issue> issues_;
  std::map<int, std::size_t> counts_;
};

}  // namespace citymesh
