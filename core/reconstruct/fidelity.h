#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/citymodel/shell.h"
#include "core/reconstruct/roles.h"

namespace citymesh {

/// Untyped faces that lie in one of the given vertical faces of the input take its type and source;
/// the others become walls that are `added`.
void name_walls(Shell& result, const Shell& input, std::span<const std::uint32_t> vertical);

/// Whether a closed shell keeps the input: what of its faces is not on the result is inside it,
/// except for crumbs, and for walls with air on both sides: those that enclose nothing.
bool is_faithful(const Shell& result, const Shell& input, std::span<const FaceRole> roles);

}  // namespace citymesh
