#include <string>
#include <string_view>

#include "core/base/text.h"
#include "core/source/soup.h"
#include "core/source/soup_readers.h"

namespace citymesh::source {
namespace {

class PolyReader {
 public:
  PolyReader(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts)
      : input_(bytes, options.limits.max_building_bytes),
        options_(options),
        facts_(facts),
        soup_(options) {}

  Result<void> read(const FeatureSink& sink) {
    facts_.format = "POLY";
    if (!read_nodes()) return finish(sink);
    if (!next("the facets are missing")) return {};
    const auto count = number_from<std::uint64_t>(next_word(line_));
    if (!count) return fail_here("expected the number of facets"), Result<void>{};
    soup_.add_building({});
    for (std::uint64_t f = 0; f < *count; ++f) {
      if (options_.stop.stop_requested()) return reading_stopped();
      if (!next("the file ends after " + std::to_string(f) + " of " + std::to_string(*count) +
                " facets") ||
          !read_facet())
        return {};
    }
    return soup_.deliver(GeometryType::Solid, sink);
  }

 private:
  bool fail_here(const std::string& what) {
    fail_at_line(facts_, input_.line(), what);
    return false;
  }
  Result<void> finish(const FeatureSink& sink) {
    if (options_.stop.stop_requested()) return reading_stopped();
    return too_many_points_ ? soup_.deliver_too_large(sink) : Result<void>{};
  }

  bool next(const std::string& what_if_none) {
    return next_statement(input_, text_, line_, facts_) || fail_here(what_if_none);
  }

  bool read_nodes() {
    if (!next("the file is empty")) return false;
    const auto count = number_from<std::uint64_t>(next_word(line_));
    const auto dimension = number_from<int>(next_word(line_));
    if (!count || dimension != 3)
      return fail_here("expected the number of nodes and 3 as their dimension");
    if (*count == 0) return fail_here("the nodes stand in a file of their own, which is not read");
    for (std::uint64_t n = 0; n < *count; ++n) {
      if (options_.stop.stop_requested()) return false;
      if (!next("the file ends after " + std::to_string(n) + " of " + std::to_string(*count) +
                " nodes"))
        return false;
      const auto number = number_from<std::int64_t>(next_word(line_));
      const auto point = point_from(line_);
      if (!number || !point) return fail_here("a node needs its number and three coordinates");
      if (n == 0) first_node_ = *number == 1 ? 1 : 0;
      if (*number != first_node_ + static_cast<std::int64_t>(n))
        return fail_here("node " + std::to_string(*number) + " stands where " +
                         std::to_string(first_node_ + static_cast<std::int64_t>(n)) +
                         " is expected");
      too_many_points_ = n == options_.limits.max_points_per_building;
      if (too_many_points_) return false;
      soup_.add_point(*point);
    }
    return true;
  }

  bool read_facet() {
    const auto polygons = number_from<std::uint64_t>(next_word(line_));
    const auto holes = next_word(line_);
    const auto hole_count = holes.empty() ? 0 : number_from<std::uint64_t>(holes);
    if (!polygons || !hole_count)
      return fail_here("a facet begins with the numbers of its polygons and holes");
    soup_.begin_face(0);
    for (std::uint64_t p = 0; p < *polygons; ++p) {
      if (p > 0) soup_.next_ring();
      if (!next("the file ends in a facet") || !read_polygon()) return false;
    }
    // Points that say where the holes are; which rings they are is known without.
    for (std::uint64_t h = 0; h < *hole_count; ++h)
      if (!next("the file ends in a facet")) return false;
    return true;
  }

  bool read_polygon() {
    const auto count = number_from<std::uint64_t>(next_word(line_));
    if (!count) return fail_here("a polygon begins with the number of its nodes");
    for (std::uint64_t i = 0; i < *count; ++i) {
      auto word = next_word(line_);
      if (word.empty()) {
        if (!next("the file ends in a polygon")) return false;
        word = next_word(line_);
      }
      const auto node = number_from<std::int64_t>(word);
      if (!node) return fail_here("'" + std::string(word.substr(0, 60)) + "' is no node number");
      const auto last = first_node_ + static_cast<std::int64_t>(soup_.point_count()) - 1;
      const bool known = *node >= first_node_ && *node <= last;
      soup_.add_corner(known ? *node - first_node_ : -1, *node);
    }
    return true;
  }

  Input input_;
  const DocumentOptions& options_;
  DocumentFacts& facts_;
  Soup soup_;
  std::string text_{};
  std::string_view line_{};
  std::int64_t first_node_ = 0;  ///< 0 or 1
  bool too_many_points_ = false;
};

}  // namespace

Result<void> read_poly(ByteReader& bytes, const DocumentOptions& options, DocumentFacts& facts,
                       const FeatureSink& sink) {
  return PolyReader(bytes, options, facts).read(sink);
}

}  // namespace citymesh::source
