#pragma once

#include "core/source/feature.h"
#include "core/source/input.h"

/// Readers of files that know polygons or solids but no buildings: every file, group or feature is
/// one, of level of detail 2. What is wrong with the document as a whole ends up in
/// `facts.failure`, with line or byte; then nothing of a mesh file is delivered, the features of a
/// JSON file before and after it are. What is wrong with a face is an issue of its building. Mesh
/// files are kept in memory. The results are errors only when the sink returned one or a stop was
/// requested.
namespace citymesh::source {

/// Wavefront OBJ: one building per object (`o`), else per group (`g`), else one. Parts of one name
/// belong together; "Name__WallSurface" tells building and surface type.
Result<void> read_obj(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                      const FeatureSink& sink);

/// Object File Format, text: one building.
Result<void> read_off(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                      const FeatureSink& sink);

/// STL text: one building per solid; solids named "Name__WallSurface" and so on join to one.
Result<void> read_stl_text(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                           const FeatureSink& sink);

/// STL binary: one building.
Result<void> read_stl_binary(ByteReader& bytes, const DocumentOptions& options,
                             DocumentFacts& facts, const FeatureSink& sink);

/// PLY text and binary of both byte orders: one building, or one per value of the property `body`
/// of its faces.
Result<void> read_ply(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                      const FeatureSink& sink);

/// POLY as TetGen and val3dity write it: the facets are the shell of one solid, rings of a facet
/// behind its first are holes. What stands behind the facets is not used.
Result<void> read_poly(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                       const FeatureSink& sink);

/// tu3djson: one building per feature.
Result<void> read_tu3djson(const RandomReader& file, const DocumentOptions& options,
                           DocumentFacts& facts, const FeatureSink& sink);

/// JSON-FG: one building per feature, of any type, by its `place`. A document that has no `place`
/// at all is GeoJSON and refused as no city model.
Result<void> read_json_fg(const RandomReader& file, const DocumentOptions& options,
                          DocumentFacts& facts, const FeatureSink& sink);

}  // namespace citymesh::source
