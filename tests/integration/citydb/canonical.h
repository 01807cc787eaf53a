#pragma once

#include <string>

#include "core/citymodel/building.h"

namespace citymesh {

/// Where a city model has been; each loses something.
enum class Store { File, V4, V5 };

/// A building as text, a line per fact, sorted: equal for equal buildings whichever way they came.
/// What the stores lose is left out of all, and said here:
/// - Order: of attributes, surfaces, geometries, polygons, parts and installations.
/// - `creationDate`: importers give one to what has none.
/// - Ids that an importer made up for objects, surfaces and polygons without one.
/// - Cavities: importers drop inner shells, with the polygons of nothing else.
/// - Nesting and kind of lists of surfaces: a MultiSurface, CompositeSurface or one polygon is a
///   list of polygons; the decimal of a LoD (2.2), which the tables do not have.
/// - What was read but is no part of the model: issues, counts of extensions.
/// - Rings of fewer than four corners, which are none for PostGIS, and that a ring was not closed.
std::string canonical(const Building& building);

}  // namespace citymesh
