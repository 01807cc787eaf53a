#pragma once

#include "core/source/byte_reader.h"
#include "core/source/feature.h"

namespace citymesh::source {

/// Reads a CityJSON 1.0, 1.1 or 2.0 document: every Building with its BuildingParts, in the order
/// of CityObjects, then parts without a building. The list of vertices stays in memory, city
/// objects are parsed one by one; one that cannot be parsed is named in `facts.failure` and the
/// others go on. The result is an error only when the sink returned one or a stop was requested.
Result<void> read_cityjson(const RandomReader& file, const DocumentOptions& options,
                           DocumentFacts& facts, const FeatureSink& sink);

/// The same for a CityJSONSeq document, one feature per line.
Result<void> read_cityjson_seq(ByteReader& bytes, const DocumentOptions& options,
                               DocumentFacts& facts, const FeatureSink& sink);

}  // namespace citymesh::source
