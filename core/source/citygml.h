#pragma once

#include "core/source/byte_reader.h"
#include "core/source/feature.h"

namespace citymesh::source {

/// Reads a CityGML 1.0, 2.0 or 3.0 document from front to back and hands every top-level building
/// to the sink as soon as it ends. What is wrong with the document as a whole ends up in
/// `facts.failure`; buildings that ended before have been delivered. The result is an error only
/// when the sink returned one or a stop was requested.
///
/// Attributes keep their names; code spaces and units of measure are dropped, repeated texts are
/// joined with ';', generic ones of a set are named "set.name". Parts and installations by
/// xlink:href are not joined to the building: an issue says so. Windows and doors as volumes name
/// surfaces of the wall but are no part of the shell. Elements of other namespaces are skipped and
/// counted by name. Coordinates without a third dimension lie at height 0.
Result<void> read_citygml(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                          const FeatureSink& sink);

/// Reads the document for the geometry below the wanted ids only; CRS names that it meets are added
/// to `facts`.
Result<void> collect_shared_geometry(ByteReader& bytes, const DocumentOptions& options,
                                     const std::set<std::string, std::less<>>& wanted,
                                     DocumentFacts& facts, SharedGeometry& shared);

}  // namespace citymesh::source
