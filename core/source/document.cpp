#include "core/source/document.h"

#include "core/source/byte_reader.h"
#include "core/source/citygml.h"
#include "core/source/cityjson.h"
#include "core/source/soup_readers.h"

namespace citymesh::source {
std::uint32_t DocumentFacts::intern_srs(std::string_view name) {
  constexpr std::size_t kMaxNames = 1000;  // real documents have one or two
  for (std::size_t i = 0; i < srs_names.size(); ++i)
    if (srs_names[i] == name) return static_cast<std::uint32_t>(i);
  if (srs_names.size() < kMaxNames)
    srs_names.emplace_back(name);
  else if (srs_names.size() == kMaxNames)
    srs_names.emplace_back("more than 1000 different CRS names");
  return static_cast<std::uint32_t>(srs_names.size() - 1);
}

void DocumentFacts::count_skipped(std::string_view type) { count_name(skipped_types, type); }

std::string numbered_id(std::string_view stem, std::uint64_t n) {
  std::string id(stem);
  id += '_';
  id += std::to_string(n);
  return id;
}

std::string file_stem(const std::filesystem::path& path) {
  std::filesystem::path name = path.filename();
  if (name.extension() == ".gz") name = name.stem();
  name = name.stem();
  if (name.extension() == ".city" || name.extension() == ".fg") name = name.stem();
  return name.string();
}

namespace {

using RandomRead = Result<void> (*)(const RandomReader&, const DocumentOptions&, DocumentFacts&,
                                    const FeatureSink&);
using StreamRead = Result<void> (*)(ByteReader&, const DocumentOptions&, DocumentFacts&,
                                    const FeatureSink&);

// Null for formats that are read from front to back.
RandomRead random_reader(Format format) {
  switch (format) {
    case Format::CityJson:
      return read_cityjson;
    case Format::Tu3dJson:
      return read_tu3djson;
    case Format::JsonFg:
      return read_json_fg;
    default:
      return nullptr;
  }
}

StreamRead stream_reader(Format format) {
  switch (format) {
    case Format::CityJsonSeq:
      return read_cityjson_seq;
    case Format::Obj:
      return read_obj;
    case Format::Off:
      return read_off;
    case Format::StlText:
      return read_stl_text;
    case Format::StlBinary:
      return read_stl_binary;
    case Format::Ply:
      return read_ply;
    case Format::Poly:
      return read_poly;
    default:
      return read_citygml;
  }
}

}  // namespace

Result<void> read_document(const std::filesystem::path& path, Format format,
                           const DocumentOptions& options, DocumentFacts& facts,
                           const FeatureSink& sink) {
  if (const auto reader = random_reader(format)) {
    const auto file = RandomReader::open(path, options.limits.max_file_bytes);
    if (file) return reader(*file, options, facts, sink);
    facts.failure = file.error().message;
    return {};
  }
  auto bytes = ByteReader::open(path, options.limits.max_file_bytes);
  if (bytes) return stream_reader(format)(*bytes, options, facts, sink);
  facts.failure = bytes.error().message;
  return {};
}

}  // namespace citymesh::source
