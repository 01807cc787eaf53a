#include <optional>

#include "core/gates/parse.h"

namespace citymesh {
namespace {

/// The grammar of ASCII STL, one statement per line. Solids of one body stand side by side and come
/// out as one body; a solid without facets is no body.
class StlReader {
 public:
  explicit StlReader(const ParsedBodySink& sink) : sink_(sink) {}

  Result<void> line(std::string_view text, std::uint64_t number) {
    std::string_view rest = text;
    const std::string_view keyword = next_word(rest);
    if (keyword.empty()) return {};
    switch (expected_) {
      case Expected::Solid:
        if (keyword != "solid") return unexpected(keyword, "solid", number);
        return begin_solid(rest, number);
      case Expected::Facet:
        if (keyword == "endsolid") return end_solid(rest, number);
        if (keyword != "facet" || next_word(rest) != "normal")
          return unexpected(text, "facet normal", number);
        expected_ = Expected::Loop;
        return begin_facet(rest, number);
      case Expected::Loop:
        if (keyword != "outer" || next_word(rest) != "loop")
          return unexpected(text, "outer loop", number);
        expected_ = Expected::Vertex;
        corners_ = 0;
        return {};
      case Expected::Vertex:
        if (keyword != "vertex") return unexpected(keyword, "vertex", number);
        return vertex(rest, number);
      case Expected::EndLoop:
        if (keyword != "endloop") return unexpected(keyword, "endloop", number);
        expected_ = Expected::EndFacet;
        return {};
      case Expected::EndFacet:
        if (keyword != "endfacet") return unexpected(keyword, "endfacet", number);
        expected_ = Expected::Facet;
        return {};
    }
    return {};
  }

  Result<void> end() {
    if (expected_ != Expected::Solid)
      return fail(ErrorCode::DataLoss, "the file ends inside of solid " + in_quotes(solid_));
    return flush();
  }

 private:
  enum class Expected { Solid, Facet, Loop, Vertex, EndLoop, EndFacet };

  static Error unexpected(std::string_view found, std::string_view expected, std::uint64_t number) {
    return line_error(number,
                      "expected " + in_quotes(expected) + " instead of " + in_quotes(found));
  }

  Result<void> begin_solid(std::string_view rest, std::uint64_t number) {
    solid_ = next_word(rest);
    if (solid_.empty() || !next_word(rest).empty())
      return line_error(number, "a solid needs one name");
    const PatchName parts = split_patch_name(solid_);
    patch_ = parts.patch;
    expected_ = Expected::Facet;
    if (body_ && (parts.body.empty() || parts.body != body_->name))
      if (auto flushed = flush(); !flushed) return flushed;
    if (!body_) body_.emplace().name = parts.body;
    return {};
  }

  Result<void> end_solid(std::string_view rest, std::uint64_t number) {
    if (next_word(rest) != solid_)
      return line_error(number, "expected the end of solid " + in_quotes(solid_));
    expected_ = Expected::Solid;
    return {};
  }

  static Result<void> begin_facet(std::string_view rest, std::uint64_t number) {
    const auto normal = parse_point(rest, number);  // its value is a hint, the corners decide
    return normal ? Result<void>{} : normal.error();
  }

  Result<void> vertex(std::string_view rest, std::uint64_t number) {
    const auto point = parse_point(rest, number);
    if (!point) return point.error();
    body_->points.push_back(*point);
    if (++corners_ < 3) return {};
    const auto last = static_cast<std::uint32_t>(body_->points.size() - 1);
    body_->triangles.push_back({last - 2, last - 1, last});
    body_->patches.push_back(patch_);
    expected_ = Expected::EndLoop;
    return {};
  }

  Result<void> flush() {
    if (!body_) return {};
    ParsedBody complete = std::move(*body_);
    body_.reset();
    return complete.triangles.empty() ? Result<void>{} : sink_(std::move(complete));
  }

  const ParsedBodySink& sink_;
  Expected expected_ = Expected::Solid;
  std::optional<ParsedBody> body_{};
  std::string solid_{};
  std::string patch_{};
  int corners_ = 0;
};

template <class Input>
Result<void> parse(const Input& input, const ParsedBodySink& sink) {
  StlReader reader(sink);
  auto read = for_each_line(input, [&reader](std::string_view text, std::uint64_t number) {
    return reader.line(text, number);
  });
  return read ? reader.end() : read;
}

}  // namespace

Result<void> parse_stl_text(std::string_view text, const ParsedBodySink& sink) {
  return parse(text, sink);
}

Result<void> parse_stl_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  return parse(file, sink);
}

}  // namespace citymesh
