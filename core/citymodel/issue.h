#pragma once

#include <string>
#include <string_view>

namespace citymesh {

/// A defect of the input: val3dity's numbers (101 … 601), own codes as 10101 for C101 and up.
struct Issue {
  int code = 0;
  std::string where{};    ///< gml_id of polygon or surface, ring number, coordinates
  double measured = 0.0;  ///< what the check measured, 0 where it measures nothing
};

/// A change made to the geometry.
struct Repair {
  std::string kind{};
  std::string where{};
  double displacement_m = 0.0;
};

inline constexpr int kOwnIssueBase = 10000;  ///< Issue::code of C101 is 10101

/// "203 NON_PLANAR_POLYGON_DISTANCE_PLANE", "C101 DANGLING_XLINK"; the names of docs/issues.
std::string_view issue_name(int code);
std::string issue_code_text(int code);  ///< "203", "C101"

}  // namespace citymesh
