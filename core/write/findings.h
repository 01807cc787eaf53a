#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/citymodel/issue.h"
#include "core/citymodel/shell.h"

namespace citymesh {

/// Style of each face of a shell: that of the gravest issue that names its surface or lies at one
/// of its corners, else style::kSound.
std::vector<std::uint8_t> face_findings(const Shell& shell, std::span<const Issue> issues);

/// Style of the gravest of the issues, style::kSound where there are none.
std::uint8_t gravest(std::span<const Issue> issues);

}  // namespace citymesh
