#pragma once

#include <span>
#include <vector>

#include "core/citymodel/shell.h"
#include "core/write/drawing.h"

namespace citymesh {

/// Faces of a boundary that may be open or turned inside out: all of them, each towards the viewer.
/// `styles` has one per face; `back` is that of faces seen from their back, or style::kOther to
/// keep the face's own.
std::vector<DrawnFace> drawn_faces(std::span<const GridPoint> points, std::span<const Face> faces,
                                   std::span<const std::uint8_t> styles, std::uint8_t back);

/// Triangles of a face; of one that crosses itself a fan of its corners.
std::vector<Triangle> pieces(std::span<const GridPoint> points, const Face& face);

}  // namespace citymesh
