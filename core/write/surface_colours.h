#pragma once

#include <array>
#include <cstdint>

#include "core/write/writers.h"

namespace citymesh {

/// What surface types look like, sRGB, in the order of SurfaceType. They are told apart by hue and
/// by lightness.
inline constexpr std::array<std::array<std::uint8_t, 3>, kSurfaceTypeCount> kSurfaceColours{{
    {176, 180, 184},  // Unknown
    {112, 98, 76},    // GroundSurface
    {222, 205, 168},  // WallSurface
    {178, 84, 66},    // RoofSurface
    {204, 214, 224},  // ClosureSurface
    {196, 176, 146},  // OuterCeilingSurface
    {146, 132, 116},  // OuterFloorSurface
    {96, 148, 190},   // Window
    {122, 84, 52},    // Door
    {236, 230, 214},  // InteriorWallSurface
    {242, 242, 236},  // CeilingSurface
    {166, 142, 104},  // FloorSurface
}};

}  // namespace citymesh
