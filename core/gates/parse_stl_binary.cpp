#include <simdjson.h>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>

#include "core/gates/parse.h"

namespace citymesh {
namespace {

constexpr std::size_t kHeadBytes = 84;  // 80 of text, 4 of count
constexpr std::size_t kTriangleBytes = 50;
constexpr std::size_t kNormalBytes = 12;

std::uint32_t little_endian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = (value << 8) | static_cast<unsigned char>(bytes[i]);
  return value;
}

double coordinate(const char* bytes) {
  return static_cast<double>(std::bit_cast<float>(little_endian(bytes)));
}

/// Takes the next `count` triangles of the file, 50 bytes each.
using TriangleSource = std::function<Result<void>(std::uint64_t count, std::string& bytes)>;

void append_triangles(ParsedBody& body, std::string_view bytes, const std::string& patch) {
  for (std::size_t at = 0; at + kTriangleBytes <= bytes.size(); at += kTriangleBytes) {
    const auto first = static_cast<std::uint32_t>(body.points.size());
    const char* corner = bytes.data() + at + kNormalBytes;
    for (int i = 0; i < 3; ++i, corner += 12)
      body.points.push_back({coordinate(corner), coordinate(corner + 4), coordinate(corner + 8)});
    body.triangles.push_back({first, first + 1, first + 2});
    body.patches.push_back(patch);
  }
}

Error sidecar_error(std::string_view what) {
  return fail(ErrorCode::DataLoss, "sidecar: " + std::string(what));
}

/// Walks the ranges of the sidecar in file order and the triangles with them.
Result<void> read_patches(simdjson::ondemand::document& sidecar, std::uint64_t total,
                          const TriangleSource& next_triangles, const ParsedBodySink& sink) {
  std::optional<ParsedBody> body;
  const auto flush = [&]() -> Result<void> {
    if (!body) return {};
    ParsedBody complete = std::move(*body);
    body.reset();
    return sink(std::move(complete));
  };

  std::uint64_t done = 0;
  std::string bytes;
  for (simdjson::ondemand::object patch : sidecar["patches"].get_array()) {
    std::string body_name;
    auto named = patch["body"];
    if (named.error() != simdjson::NO_SUCH_FIELD) body_name = std::string_view(named.get_string());
    const std::string type(std::string_view(patch["surface_type"].get_string()));
    const std::uint64_t first = patch["first_triangle"].get_uint64();
    const std::uint64_t count = patch["triangle_count"].get_uint64();
    if (first != done || count > total - done)
      return sidecar_error("the range of " + std::to_string(count) + " triangles from " +
                           std::to_string(first) + " does not follow triangle " +
                           std::to_string(done) + " of " + std::to_string(total));
    if (body && (body_name.empty() || body_name != body->name))
      if (auto flushed = flush(); !flushed) return flushed;
    if (!body) {
      body.emplace().name = body_name;
      body->float32 = true;
    }
    if (auto got = next_triangles(count, bytes); !got) return got;
    append_triangles(*body, bytes, type);
    done += count;
  }
  if (done != total)
    return sidecar_error("names " + std::to_string(done) + " triangles, the file has " +
                         std::to_string(total));
  return flush();
}

Result<void> read_with_sidecar(const simdjson::padded_string& json, std::uint64_t total,
                               const TriangleSource& next_triangles, const ParsedBodySink& sink) {
  try {
    simdjson::ondemand::parser parser;
    simdjson::ondemand::document document = parser.iterate(json);
    return read_patches(document, total, next_triangles, sink);
  } catch (const simdjson::simdjson_error& error) {
    return sidecar_error(error.what());
  }
}

std::filesystem::path sidecar_of(const std::filesystem::path& file) {
  std::filesystem::path sidecar = file;
  return sidecar.replace_extension(".patches.json");
}

}  // namespace

Result<void> parse_binary_stl_text(std::string_view text, const ParsedBodySink& sink) {
  if (text.size() < kHeadBytes)
    return fail(ErrorCode::DataLoss,
                "binary STL of " + std::to_string(text.size()) + " bytes: expected at least 84");
  const std::uint64_t total = little_endian(text.data() + 80);
  const std::uint64_t end = kHeadBytes + total * kTriangleBytes;
  if (text.size() < end)
    return fail(ErrorCode::DataLoss, "binary STL of " + std::to_string(text.size()) +
                                         " bytes: expected " + std::to_string(end) + " for " +
                                         std::to_string(total) + " triangles");
  std::size_t at = kHeadBytes;
  const auto next = [&](std::uint64_t count, std::string& bytes) -> Result<void> {
    const auto size = static_cast<std::size_t>(count * kTriangleBytes);
    bytes.assign(text, at, size);
    at += size;
    return {};
  };
  return read_with_sidecar(simdjson::padded_string(text.substr(static_cast<std::size_t>(end))),
                           total, next, sink);
}

Result<void> parse_binary_stl_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (error) return file_error(file, error.value());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"),
                                                               &std::fclose);
  if (!stream) return file_error(file, errno);

  std::string head(kHeadBytes, '\0');
  if (std::fread(head.data(), 1, head.size(), stream.get()) != head.size())
    return fail(ErrorCode::DataLoss, std::to_string(size) + " bytes: expected at least 84");
  const std::uint64_t total = little_endian(head.data() + 80);
  if (size != kHeadBytes + total * kTriangleBytes)
    return fail(ErrorCode::DataLoss, std::to_string(size) + " bytes: expected " +
                                         std::to_string(kHeadBytes + total * kTriangleBytes) +
                                         " for " + std::to_string(total) + " triangles");

  simdjson::padded_string sidecar;
  if (simdjson::padded_string::load(sidecar_of(file).string()).get(sidecar) != simdjson::SUCCESS)
    return fail(ErrorCode::NotFound, "cannot read " + sidecar_of(file).filename().string());

  const auto next = [&](std::uint64_t count, std::string& bytes) -> Result<void> {
    bytes.resize(static_cast<std::size_t>(count * kTriangleBytes));
    if (std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size())
      return file_error(file, errno);
    return {};
  };
  return read_with_sidecar(sidecar, total, next, sink);
}

}  // namespace citymesh
