#include <string>
#include <string_view>

#include "core/base/text.h"
#include "core/source/soup.h"
#include "core/source/soup_readers.h"

namespace citymesh::source {
namespace {

class OffReader {
 public:
  OffReader(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts)
      : input_(bytes, options.limits.max_building_bytes),
        options_(options),
        facts_(facts),
        soup_(options) {}

  Result<void> read(const FeatureSink& sink) {
    facts_.format = "OFF";
    if (!read_header()) return {};
    for (std::uint64_t v = 0; v < vertex_count_; ++v) {
      if (options_.stop.stop_requested()) return reading_stopped();
      if (!next("vertices", v, vertex_count_)) return {};
      std::string_view rest = line_;
      const auto point = point_from(rest);
      if (!point) return fail_here("a vertex needs three numbers"), Result<void>{};
      if (v == options_.limits.max_points_per_building) return soup_.deliver_too_large(sink);
      soup_.add_point(*point);
    }
    soup_.add_building({});
    for (std::uint64_t f = 0; f < face_count_; ++f) {
      if (options_.stop.stop_requested()) return reading_stopped();
      if (!next("faces", f, face_count_)) return {};
      if (!read_face()) return {};
    }
    if (next_line())
      fail_here("there is more than the " + std::to_string(vertex_count_) + " vertices and " +
                std::to_string(face_count_) + " faces of the header");
    if (!facts_.failure.empty()) return {};
    return soup_.deliver(GeometryType::MultiSurface, sink);
  }

 private:
  bool fail_here(const std::string& what) {
    fail_at_line(facts_, input_.line(), what);
    return false;
  }

  bool next_line() { return next_statement(input_, text_, line_, facts_); }
  bool next(std::string_view things, std::uint64_t done, std::uint64_t count) {
    return next_line() || fail_here("the file ends after " + std::to_string(done) + " of " +
                                    std::to_string(count) + " " + std::string(things));
  }

  bool read_header() {
    if (!next_line()) return fail_here("the file is empty");
    if (line_.starts_with("\xef\xbb\xbf")) line_.remove_prefix(3);
    if (const auto at = line_.find("OFF"); at != line_.npos) {
      const auto keyword = next_word(line_);
      if (keyword.find_first_of("4n") != keyword.npos)
        return fail_here("'" + std::string(keyword.substr(0, 20)) +
                         "' has points of other than three dimensions");
      if (trimmed(line_) == "BINARY") return fail_here("binary OFF is not read");
      if (trimmed(line_).empty() && !next_line())
        return fail_here("the numbers of vertices and faces are missing");
    }
    const auto vertices = number_from<std::uint64_t>(next_word(line_));
    const auto faces = number_from<std::uint64_t>(next_word(line_));
    if (!vertices || !faces) return fail_here("expected the numbers of vertices, faces and edges");
    vertex_count_ = *vertices;
    face_count_ = *faces;
    return true;
  }

  bool read_face() {
    const auto count = number_from<std::uint64_t>(next_word(line_));
    if (!count) return fail_here("a face begins with the number of its vertices");
    soup_.begin_face(0);
    for (std::uint64_t i = 0; i < *count; ++i) {
      const auto index = number_from<std::int64_t>(next_word(line_));
      if (!index)
        return fail_here("the face has fewer than the " + std::to_string(*count) +
                         " vertices that it states");
      const bool known = *index < static_cast<std::int64_t>(vertex_count_);
      soup_.add_corner(known ? *index : -1, *index);
    }
    return true;
  }

  Input input_;
  const DocumentOptions& options_;
  DocumentFacts& facts_;
  Soup soup_;
  std::string text_{};
  std::string_view line_{};
  std::uint64_t vertex_count_ = 0, face_count_ = 0;
};

}  // namespace

Result<void> read_off(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                      const FeatureSink& sink) {
  return OffReader(bytes, options, facts).read(sink);
}

}  // namespace citymesh::source
