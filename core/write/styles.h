#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace citymesh {

/// How a building or a face is shown to people.
struct Style {
  std::string_view name;     ///< of rungs as in report.json
  std::string_view meaning;  ///< half a sentence
  std::array<std::uint8_t, 3> colour;
};

/// The rungs from the best to the last resort, what is no rung, then what pictures tell of defects,
/// from the mildest to the gravest.
inline constexpr std::array kStyles{
    Style{"as_is", "unchanged, on the 0.1 mm grid", {222, 205, 168}},
    Style{"healed", "repaired within the tolerances", {134, 186, 172}},
    Style{"rebuilt_2_5d", "rebuilt from its roof planes", {120, 163, 209}},
    Style{"rebuilt_3d", "rebuilt from an arrangement of its faces", {158, 141, 209}},
    Style{"reconstructed", "reconstructed from its appearance", {209, 143, 184}},
    Style{"wrapped", "wrapped in a new skin", {229, 166, 77}},
    Style{"lod1_block", "replaced by a block of its height", {218, 108, 82}},
    Style{"", "", {176, 180, 184}},
    Style{"sound", "without defects", {216, 212, 202}},
    Style{"inside", "seen from its back", {150, 158, 172}},
    Style{"source", "found while reading, and own codes", {158, 128, 92}},
    Style{"ring", "defects of rings, 1xx", {238, 196, 84}},
    Style{"polygon", "defects of polygons, 2xx", {236, 142, 62}},
    Style{"shell", "defects of shells, 3xx", {208, 72, 60}},
    Style{"solid", "defects of solids and buildings, 4xx to 6xx", {166, 80, 158}},
    Style{"new", "no source has this face", {112, 184, 62}},
};

namespace style {
inline constexpr std::uint8_t kOther = 7;
inline constexpr std::uint8_t kSound = 8;
inline constexpr std::uint8_t kInside = 9;
inline constexpr std::uint8_t kFirstFinding = 10;
inline constexpr std::uint8_t kLastFinding = 14;
inline constexpr std::uint8_t kNew = 15;
}  // namespace style

inline constexpr std::uint8_t rung_style(std::string_view rung) {
  for (std::uint8_t i = 0; i < style::kOther; ++i)
    if (kStyles[i].name == rung) return i;
  return style::kOther;
}

/// By the family of an issue's code; own codes tell what was found while reading.
inline constexpr std::uint8_t finding_style(int code) {
  if (code >= 100 && code < 400) return static_cast<std::uint8_t>(10 + code / 100);
  return code >= 400 && code < 700 ? style::kLastFinding : style::kFirstFinding;
}

}  // namespace citymesh
