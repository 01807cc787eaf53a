#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/geometry/point.h"

namespace citymesh {

/// A defect of the input: val3dity's numbers (101 … 601), own codes as 10101 for C101 and up.
struct Issue {
  int code = 0;
  std::string where{};         ///< gml_id of polygon or surface, ring number, coordinates
  double measured = 0.0;       ///< what the check measured, 0 where it measures nothing
  std::optional<Point3> at{};  ///< where it is best seen, metres from the local origin
  bool assembled = false;  ///< of a shell that the source does not state as one: it was collected
                           ///< from boundary surfaces
};

/// A change made to the geometry.
struct Repair {
  std::string kind{};
  std::string where{};
  double displacement_m = 0.0;
  std::optional<Point3> at{};  ///< as in Issue
};

inline constexpr int kOwnIssueBase = 10000;  ///< Issue::code of C101 is 10101

/// Own codes. The first ones are found while reading.
namespace issue_code {
inline constexpr int kDanglingXlink = 10101;
inline constexpr int kCyclicXlink = 10102;
inline constexpr int kUnreadableRing = 10103;
inline constexpr int kNonFiniteCoordinate = 10104;
inline constexpr int kCoordinateOutOfRange = 10105;
inline constexpr int kUntransformableCoordinate = 10106;
inline constexpr int kReadLimitExceeded = 10107;
inline constexpr int kUnreadableGeometry = 10108;
inline constexpr int kVertexIndexOutOfRange = 10109;
inline constexpr int kUnknownCrs = 10110;
// Found by the delivery gates where val3dity has no number.
inline constexpr int kEulerFormula = 10111;
inline constexpr int kDegenerateTriangle = 10112;
inline constexpr int kTJunction = 10113;
inline constexpr int kDuplicateFace = 10114;
inline constexpr int kEncodingLoss = 10115;
// Between buildings.
inline constexpr int kBuildingsOverlap = 10116;
inline constexpr int kNearDuplicateWall = 10117;
inline constexpr int kNarrowGap = 10118;
// Of a building, but no defect of its geometry.
inline constexpr int kFootprintTurned = 10119;
// Found after healing.
inline constexpr int kPartsNotMerged = 10120;
inline constexpr int kPartsOverlap = 10121;
}  // namespace issue_code

/// "203 NON_PLANAR_POLYGON_DISTANCE_PLANE", "C101 DANGLING_XLINK"; the names of docs/issues.
std::string_view issue_name(int code);
std::string issue_code_text(int code);  ///< "203", "C101"

/// Whether a building with it is defective; C117 to C121 are worth knowing, but break no
/// rule of ISO 19107.
bool is_defect(int code);

}  // namespace citymesh
