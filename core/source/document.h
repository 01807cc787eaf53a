#pragma once

#include <filesystem>
#include <string>

#include "core/source/feature.h"

namespace citymesh::source {

enum class Format {
  CityGml,
  CityJson,
  CityJsonSeq,
  JsonFg,
  Tu3dJson,
  Obj,
  Off,
  Ply,
  Poly,
  StlText,
  StlBinary
};

/// What a file holds, found by what stands in it; its name decides between texts of bare numbers
/// only. Errors: as ByteReader; InvalidArgument for what
/// is none of the formats. `name` is what the file was called where it came from.
Result<Format> detect_format(const std::filesystem::path& path, const std::string& name,
                             const ReadLimits& limits);

/// Reads a document of any format. See read_citygml for what becomes of defects.
Result<void> read_document(const std::filesystem::path& path, Format format,
                           const DocumentOptions& options, DocumentFacts& facts,
                           const FeatureSink& sink);

/// "3910_5817" of "tiles/3910_5817.gml.gz".
std::string file_stem(const std::filesystem::path& path);

}  // namespace citymesh::source
