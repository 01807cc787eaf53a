#include "core/citymodel/issue.h"

#include <algorithm>
#include <array>

namespace citymesh {
namespace {

struct IssueName {
  int code;
  std::string_view text;  // number and name
};

// The one table of issue codes, sorted by code. Up to 906: val3dity's.
constexpr std::array kIssueNames{
    IssueName{101, "101 TOO_FEW_POINTS"},
    IssueName{102, "102 CONSECUTIVE_POINTS_SAME"},
    IssueName{103, "103 RING_NOT_CLOSED"},
    IssueName{104, "104 RING_SELF_INTERSECTION"},
    IssueName{201, "201 INTERSECTION_RINGS"},
    IssueName{202, "202 DUPLICATED_RINGS"},
    IssueName{203, "203 NON_PLANAR_POLYGON_DISTANCE_PLANE"},
    IssueName{204, "204 NON_PLANAR_POLYGON_NORMALS_DEVIATION"},
    IssueName{205, "205 POLYGON_INTERIOR_DISCONNECTED"},
    IssueName{206, "206 INNER_RING_OUTSIDE"},
    IssueName{207, "207 INNER_RINGS_NESTED"},
    IssueName{208, "208 ORIENTATION_RINGS_SAME"},
    IssueName{301, "301 TOO_FEW_POLYGONS"},
    IssueName{302, "302 SHELL_NOT_CLOSED"},
    IssueName{303, "303 NON_MANIFOLD_CASE"},
    IssueName{305, "305 MULTIPLE_CONNECTED_COMPONENTS"},
    IssueName{306, "306 SHELL_SELF_INTERSECTION"},
    IssueName{307, "307 POLYGON_WRONG_ORIENTATION"},
    IssueName{401, "401 INTERSECTION_SHELLS"},
    IssueName{402, "402 DUPLICATED_SHELLS"},
    IssueName{403, "403 INNER_SHELL_OUTSIDE"},
    IssueName{404, "404 SOLID_INTERIOR_DISCONNECTED"},
    IssueName{405, "405 WRONG_ORIENTATION_SHELL"},
    IssueName{501, "501 INTERSECTION_SOLIDS"},
    IssueName{502, "502 DUPLICATED_SOLIDS"},
    IssueName{503, "503 DISCONNECTED_SOLIDS"},
    IssueName{601, "601 BUILDINGPARTS_OVERLAP"},
    IssueName{901, "901 INVALID_INPUT_FILE"},
    IssueName{902, "902 EMPTY_PRIMITIVE"},
    IssueName{903, "903 WRONG_INPUT_PARAMETERS"},
    IssueName{904, "904 FORMAT_NOT_SUPPORTED"},
    IssueName{905, "905 NOT_VALID_PRIMITIVE"},
    IssueName{906, "906 PRIMITIVE_NO_GEOMETRY"},
    IssueName{issue_code::kDanglingXlink, "C101 DANGLING_XLINK"},
    IssueName{issue_code::kCyclicXlink, "C102 CYCLIC_XLINK"},
    IssueName{issue_code::kUnreadableRing, "C103 UNREADABLE_RING"},
    IssueName{issue_code::kNonFiniteCoordinate, "C104 NON_FINITE_COORDINATE"},
    IssueName{issue_code::kCoordinateOutOfRange, "C105 COORDINATE_OUT_OF_RANGE"},
    IssueName{issue_code::kUntransformableCoordinate, "C106 UNTRANSFORMABLE_COORDINATE"},
    IssueName{issue_code::kReadLimitExceeded, "C107 READ_LIMIT_EXCEEDED"},
    IssueName{issue_code::kUnreadableGeometry, "C108 UNREADABLE_GEOMETRY"},
    IssueName{issue_code::kVertexIndexOutOfRange, "C109 VERTEX_INDEX_OUT_OF_RANGE"},
    IssueName{issue_code::kUnknownCrs, "C110 UNKNOWN_CRS"},
    IssueName{issue_code::kEulerFormula, "C111 EULER_FORMULA"},
    IssueName{issue_code::kDegenerateTriangle, "C112 DEGENERATE_TRIANGLE"},
    IssueName{issue_code::kTJunction, "C113 T_JUNCTION"},
    IssueName{issue_code::kDuplicateFace, "C114 DUPLICATE_FACE"},
    IssueName{issue_code::kEncodingLoss, "C115 ENCODING_LOSS"},
    IssueName{issue_code::kBuildingsOverlap, "C116 BUILDINGS_OVERLAP"},
    IssueName{issue_code::kNearDuplicateWall, "C117 NEAR_DUPLICATE_WALL"},
    IssueName{issue_code::kNarrowGap, "C118 NARROW_GAP"},
    IssueName{issue_code::kFootprintTurned, "C119 FOOTPRINT_TURNED"},
    IssueName{issue_code::kPartsNotMerged, "C120 PARTS_NOT_MERGED"},
    IssueName{issue_code::kPartsOverlap, "C121 PARTS_STILL_OVERLAP"},
};

static_assert(std::is_sorted(kIssueNames.begin(), kIssueNames.end(),
                             [](const IssueName& a, const IssueName& b) {
                               return a.code < b.code;
                             }));

}  // namespace

std::string_view issue_name(int code) {
  const auto found =
      std::lower_bound(kIssueNames.begin(), kIssueNames.end(), code,
                       [](const IssueName& entry, int wanted) { return entry.code < wanted; });
  if (found == kIssueNames.end() || found->code != code) return "UNKNOWN_ISSUE";
  return found->text;
}

std::string issue_code_text(int code) {
  return code > kOwnIssueBase ? "C" + std::to_string(code - kOwnIssueBase) : std::to_string(code);
}

bool is_defect(int code) {
  return code != issue_code::kNearDuplicateWall && code != issue_code::kNarrowGap &&
         code != issue_code::kPartsNotMerged && code != issue_code::kPartsOverlap &&
         code != issue_code::kFootprintTurned;
}

}  // namespace citymesh
