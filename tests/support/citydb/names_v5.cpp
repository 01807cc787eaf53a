#include "tests/support/citydb/names_v5.h"

#include <algorithm>
#include <array>

namespace citymesh::citydb_support {
namespace {

using source::RawObject;
using source::RawShape;

constexpr std::array kKnownAttributes{
    KnownAttribute{"name", {"name", kCore}, kCode},
    KnownAttribute{"description", {"description", kCore}, kStringOrRef},
    KnownAttribute{"relativeToTerrain", {"relativeToTerrain", kCore}, kString},
    KnownAttribute{"relativeToWater", {"relativeToWater", kCore}, kString},
    KnownAttribute{"class", {"class", kBldg}, kCode},
    KnownAttribute{"function", {"function", kBldg}, kCode},
    KnownAttribute{"usage", {"usage", kBldg}, kCode},
    KnownAttribute{"roofType", {"roofType", kBldg}, kCode},
    KnownAttribute{"storeysAboveGround", {"storeysAboveGround", kBldg}, kInteger},
    KnownAttribute{"storeysBelowGround", {"storeysBelowGround", kBldg}, kInteger},
    KnownAttribute{"storeyHeightsAboveGround", {"storeyHeightsAboveGround", kBldg}, kMeasureList},
    KnownAttribute{"storeyHeightsBelowGround", {"storeyHeightsBelowGround", kBldg}, kMeasureList},
    KnownAttribute{"measuredHeight", {"height", kCon}, kHeight},
    KnownAttribute{"yearOfConstruction", {"dateOfConstruction", kCon}, kTimestamp},
    KnownAttribute{"yearOfDemolition", {"dateOfDemolition", kCon}, kTimestamp},
    KnownAttribute{"dateOfConstruction", {"dateOfConstruction", kCon}, kTimestamp},
    KnownAttribute{"dateOfDemolition", {"dateOfDemolition", kCon}, kTimestamp},
    KnownAttribute{"conditionOfConstruction", {"conditionOfConstruction", kCon}, kString},
    KnownAttribute{"relationToConstruction", {"relationToConstruction", kCon}, kString},
};

}  // namespace

const KnownAttribute* known_attribute(std::string_view name) {
  const auto known =
      std::find_if(kKnownAttributes.begin(), kKnownAttributes.end(),
                   [&](const KnownAttribute& attribute) { return attribute.name == name; });
  return known == kKnownAttributes.end() ? nullptr : &*known;
}

int class_v5(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::Building:
      return 901;
    case ObjectKind::BuildingPart:
      return 902;
    case ObjectKind::BuildingInstallation:
      return 905;
  }
  return 0;
}

int class_v5(SurfaceType type) {
  switch (type) {
    case SurfaceType::ClosureSurface:
      return 15;
    case SurfaceType::WallSurface:
      return 709;
    case SurfaceType::GroundSurface:
      return 710;
    case SurfaceType::InteriorWallSurface:
      return 711;
    case SurfaceType::RoofSurface:
      return 712;
    case SurfaceType::FloorSurface:
      return 713;
    case SurfaceType::OuterFloorSurface:
      return 714;
    case SurfaceType::CeilingSurface:
      return 715;
    case SurfaceType::OuterCeilingSurface:
      return 716;
    case SurfaceType::Door:
      return 718;
    case SurfaceType::Window:
      return 719;
    case SurfaceType::Unknown:
      break;
  }
  return 0;
}

PropertyName geometry_name(const RawObject& object, const RawShape& shape, bool citygml3) {
  constexpr std::array<std::string_view, 5> kSolids{"", "lod1Solid", "lod2Solid", "lod3Solid",
                                                    "lod4Solid"};
  constexpr std::array<std::string_view, 5> kSurfaces{"lod0MultiSurface", "lod1MultiSurface",
                                                      "lod2MultiSurface", "lod3MultiSurface",
                                                      "lod4MultiSurface"};
  constexpr std::array<std::string_view, 5> kOld{"", "", "lod2Geometry", "lod3Geometry",
                                                 "lod4Geometry"};
  const auto lod = static_cast<std::size_t>(shape.lod.major);
  if (lod >= kSolids.size()) return {};
  if (object.kind == ObjectKind::BuildingInstallation && !citygml3 && lod >= 2)
    return {kOld[lod], kDepr};
  if (!shape.solids.empty()) return {kSolids[lod], lod == 4 ? kDepr : kCore};
  return {kSurfaces[lod], lod == 1 || lod == 4 ? kDepr : kCore};
}

PropertyName surface_geometry_name(int lod) {
  constexpr std::array<std::string_view, 5> kNames{"lod0MultiSurface", "lod1MultiSurface",
                                                   "lod2MultiSurface", "lod3MultiSurface",
                                                   "lod4MultiSurface"};
  if (lod < 0 || lod >= static_cast<int>(kNames.size())) return {};
  return {kNames[static_cast<std::size_t>(lod)], lod == 4 ? kDepr : kCore};
}

std::string json_list(const std::string& text) {
  std::string list, word;
  for (const char c : text + " ") {
    if (c != ' ' && c != '\n' && c != '\t') {
      word += c;
      continue;
    }
    if (word.empty()) continue;
    const bool number = word.find_first_not_of("0123456789.-") == std::string::npos;
    list += (list.empty() ? "" : ",") + (number ? word : "\"" + word + "\"");
    word.clear();
  }
  return "[" + list + "]";
}

}  // namespace citymesh::citydb_support
