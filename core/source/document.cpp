#include "core/source/document.h"

#include <array>

#include "core/source/byte_reader.h"
#include "core/source/citygml.h"
#include "core/source/cityjson.h"

namespace citymesh::source {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

// '}' at the end of the first line and '{' behind it cannot stand in one JSON text.
Result<Format> document_or_sequence(ByteReader& bytes, std::string_view begin) {
  char last = 0;
  bool line_ended = false;
  std::array<char, 1u << 14> buffer{};
  for (;;) {
    for (const char c : begin) {
      if (c == '\n' && last != 0) {
        if (last != '}') return Format::CityJson;
        line_ended = true;
      }
      if (is_blank(c)) continue;
      if (line_ended) return c == '{' ? Format::CityJsonSeq : Format::CityJson;
      last = c;
    }
    const auto count = bytes.read(buffer.data(), buffer.size());
    if (!count) return count.error();
    if (*count == 0) return Format::CityJson;
    begin = {buffer.data(), *count};
  }
}

}  // namespace

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
  if (name.extension() == ".city") name = name.stem();
  return name.string();
}

Result<Format> detect_format(const std::filesystem::path& path, const ReadLimits& limits) {
  auto bytes = ByteReader::open(path, limits.max_file_bytes);
  if (!bytes) return bytes.error();
  std::array<char, 4096> buffer{};
  const auto count = bytes->read(buffer.data(), buffer.size());
  if (!count) return count.error();
  std::string_view begin(buffer.data(), *count);
  if (begin.substr(0, 3) == "\xef\xbb\xbf") begin.remove_prefix(3);
  while (!begin.empty() && is_blank(begin.front())) begin.remove_prefix(1);
  if (begin.empty()) return fail(ErrorCode::InvalidArgument, "the file is empty");
  const auto start = begin.substr(0, 2);
  const bool utf16 = start == "\xfe\xff" || start == "\xff\xfe";
  if (begin.front() == '<' || utf16) return Format::CityGml;
  if (begin.front() == '{') return document_or_sequence(*bytes, begin);
  return fail(ErrorCode::InvalidArgument, std::string(start == "PK" ? "the file is a zip archive"
                                                                    : "the file is neither XML "
                                                                      "nor JSON") +
                                              ", expected CityGML or CityJSON, plain or .gz");
}

Result<void> read_document(const std::filesystem::path& path, Format format,
                           const DocumentOptions& options, DocumentFacts& facts,
                           const FeatureSink& sink) {
  if (format == Format::CityJson) {
    const auto file = RandomReader::open(path, options.limits.max_file_bytes);
    if (file) return read_cityjson(*file, options, facts, sink);
    facts.format = "CityJSON";
    facts.failure = file.error().message;
    return {};
  }
  auto bytes = ByteReader::open(path, options.limits.max_file_bytes);
  if (!bytes) {
    facts.failure = bytes.error().message;
    return {};
  }
  return format == Format::CityGml ? read_citygml(*bytes, options, facts, sink)
                                   : read_cityjson_seq(*bytes, options, facts, sink);
}

}  // namespace citymesh::source
