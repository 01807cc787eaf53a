#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <string>
#include <string_view>

#include "core/base/text.h"
#include "core/source/soup.h"
#include "core/source/soup_readers.h"

namespace citymesh::source {
namespace {

bool same_word(std::string_view word, std::string_view lower_case) {
  return std::equal(
      word.begin(), word.end(), lower_case.begin(), lower_case.end(),
      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

/// The grammar of STL text, word by word; only names reach to the end of their line.
class StlTextReader {
 public:
  StlTextReader(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts)
      : input_(bytes, options.limits.max_building_bytes),
        options_(options),
        facts_(facts),
        soup_(options) {}

  Result<void> read(const FeatureSink& sink) {
    facts_.format = "STL (text)";
    std::string line;
    for (;;) {
      if (options_.stop.stop_requested()) return reading_stopped();
      const auto more = input_.next_line(line);
      if (!more) fail_reading(facts_, more.error().message);
      if (!more) return {};
      if (!*more) break;
      if (!read_line(line)) return {};
    }
    if (place_ != Place::File) {
      fail_at_line(facts_, input_.line(), "the file ends inside a solid");
      return {};
    }
    return soup_.deliver(GeometryType::MultiSurface, sink);
  }

 private:
  enum class Place { File, Solid, Facet, Loop };

  bool fail_here(std::string_view word, const std::string& expected) {
    fail_at_line(
        facts_, input_.line(),
        "'" + std::string(word.substr(0, 60)) + "' stands where " + expected + " is expected");
    return false;
  }

  bool read_line(std::string_view line) {
    for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
      switch (place_) {
        case Place::File:
          if (!same_word(word, "solid")) return fail_here(word, "'solid'");
          begin_solid(trimmed(line));
          line = {};
          place_ = Place::Solid;
          break;
        case Place::Solid:
          if (same_word(word, "endsolid")) {
            line = {};
            place_ = Place::File;
          } else if (same_word(word, "facet")) {
            if (!same_word(next_word(line), "normal") || !point_from(line))
              return fail_here(word, "'facet normal' and three numbers");
            soup_.begin_face(building_, type_);
            place_ = Place::Facet;
          } else {
            return fail_here(word, "'facet' or 'endsolid'");
          }
          break;
        case Place::Facet:
          if (same_word(word, "outer") && same_word(next_word(line), "loop"))
            place_ = Place::Loop;
          else if (same_word(word, "endfacet"))
            place_ = Place::Solid;
          else
            return fail_here(word, "'outer loop' or 'endfacet'");
          break;
        case Place::Loop:
          if (same_word(word, "endloop")) {
            place_ = Place::Facet;
          } else if (same_word(word, "vertex")) {
            const auto point = point_from(line);
            if (!point) return fail_here(word, "'vertex' and three numbers");
            soup_.add_own_corner(*point);
          } else {
            return fail_here(word, "'vertex' or 'endloop'");
          }
          break;
      }
    }
    return true;
  }

  // Only solids that are named as patches of a building belong together.
  void begin_solid(std::string_view name) {
    const PatchName patch = split_patch_name(name);
    type_ = patch.type;
    if (type_) {
      if (const auto found = patched_.find(patch.building); found != patched_.end()) {
        building_ = found->second;
        return;
      }
    }
    building_ = soup_.add_building(std::string(patch.building));
    if (type_) patched_.emplace(patch.building, building_);
  }

  Input input_;
  const DocumentOptions& options_;
  DocumentFacts& facts_;
  Soup soup_;
  Place place_ = Place::File;
  std::uint32_t building_ = 0;
  std::optional<SurfaceType> type_{};
  TextMap<std::uint32_t> patched_{};
};

std::uint32_t little_endian_u32(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

double little_endian_float(const char* bytes) {
  return static_cast<double>(std::bit_cast<float>(little_endian_u32(bytes)));
}

}  // namespace

Result<void> read_stl_text(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                           const FeatureSink& sink) {
  return StlTextReader(bytes, options, facts).read(sink);
}

Result<void> read_stl_binary(ByteReader& bytes, const DocumentOptions& options,
                             DocumentFacts& facts, const FeatureSink& sink) {
  facts.format = "STL (binary)";
  Input input(bytes, options.limits.max_building_bytes);
  const auto failed = [&](const std::string& what) {
    fail_reading(facts, "byte " + std::to_string(input.offset()) + ": " + what);
    return Result<void>{};
  };

  std::array<char, 84> header{};
  const auto begun = input.take(header.data(), header.size());
  if (!begun) return failed(begun.error().message);
  if (!*begun) return failed("the file ends in its header of 84 bytes");
  const std::uint32_t count = little_endian_u32(header.data() + 80);

  Soup soup(options);
  soup.add_building({});
  std::array<char, 50> facet{};  // normal, three corners, two bytes that mean nothing
  for (std::uint32_t f = 0; f < count; ++f) {
    if (options.stop.stop_requested()) return reading_stopped();
    const auto taken = input.take(facet.data(), facet.size());
    if (!taken) return failed(taken.error().message);
    if (!*taken)
      return failed("the file ends after " + std::to_string(f) + " of " + std::to_string(count) +
                    " facets");
    soup.begin_face(0);
    for (const char* corner = facet.data() + 12; corner != facet.data() + 48; corner += 12)
      soup.add_own_corner({little_endian_float(corner), little_endian_float(corner + 4),
                           little_endian_float(corner + 8)});
  }
  const auto more = input.take(facet.data(), 1);
  if (!more) return failed(more.error().message);
  if (*more) return failed("the file goes on behind its " + std::to_string(count) + " facets");
  return soup.deliver(GeometryType::MultiSurface, sink);
}

}  // namespace citymesh::source
