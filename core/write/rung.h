#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace citymesh {

/// How a rung of the ladder is shown to people.
struct RungStyle {
  std::string_view rung;     ///< as in report.json
  std::string_view meaning;  ///< half a sentence
  std::array<std::uint8_t, 3> colour;
};

/// From the best rung to the last resort.
inline constexpr std::array kRungStyles{
    RungStyle{"as_is", "unchanged, on the 0.1 mm grid", {222, 205, 168}},
    RungStyle{"healed", "repaired within the tolerances", {134, 186, 172}},
    RungStyle{"rebuilt_2_5d", "rebuilt from its roof planes", {120, 163, 209}},
    RungStyle{"rebuilt_3d", "rebuilt from an arrangement of its faces", {158, 141, 209}},
    RungStyle{"reconstructed", "reconstructed from its appearance", {209, 143, 184}},
    RungStyle{"wrapped", "wrapped in a new skin", {229, 166, 77}},
    RungStyle{"lod1_block", "replaced by a block of its height", {218, 108, 82}},
};
inline constexpr RungStyle kOtherRung{"", "", {176, 180, 184}};

inline constexpr std::size_t rung_index(std::string_view rung) {
  for (std::size_t i = 0; i < kRungStyles.size(); ++i)
    if (kRungStyles[i].rung == rung) return i;
  return kRungStyles.size();
}

inline constexpr const RungStyle& rung_style(std::size_t index) {
  return index < kRungStyles.size() ? kRungStyles[index] : kOtherRung;
}

}  // namespace citymesh
