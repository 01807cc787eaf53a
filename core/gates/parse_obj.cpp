#include <charconv>
#include <optional>

#include "core/gates/parse.h"

namespace citymesh {
namespace {

class ObjReader {
 public:
  explicit ObjReader(const ParsedBodySink& sink) : sink_(sink) {}

  Result<void> line(std::string_view text, std::uint64_t number) {
    std::string_view rest = text;
    const std::string_view keyword = next_word(rest);
    if (keyword.empty() || keyword.front() == '#') return {};
    if (keyword == "v") return vertex(rest, number);
    if (keyword == "f") return face(rest, number);
    if (keyword == "g") return group(rest, number);
    if (keyword == "o") return object(rest, number);
    return line_error(number, "unknown statement " + in_quotes(keyword));
  }

  Result<void> end() {
    if (!body_) return {};
    vertices_before_ += body_->points.size();
    ParsedBody complete = std::move(*body_);
    body_.reset();
    patch_.clear();
    return sink_(std::move(complete));
  }

 private:
  Result<void> object(std::string_view rest, std::uint64_t number) {
    if (auto ended = end(); !ended) return ended;
    const std::string_view name = next_word(rest);
    if (name.empty() || !next_word(rest).empty())
      return line_error(number, "an object needs one name");
    body_.emplace().name = name;
    return {};
  }

  Result<void> group(std::string_view rest, std::uint64_t number) {
    const std::string_view name = next_word(rest);
    const PatchName parts = split_patch_name(name);
    if (!body_ || parts.body != body_->name || parts.patch.empty() || !next_word(rest).empty())
      return line_error(number, "group " + in_quotes(name) + " is no patch of object " +
                                    in_quotes(body_ ? body_->name : ""));
    patch_ = parts.patch;
    return {};
  }

  Result<void> vertex(std::string_view rest, std::uint64_t number) {
    if (!body_) return line_error(number, "a vertex before the first object");
    const auto point = parse_point(rest, number);
    if (!point) return point.error();
    body_->points.push_back(*point);
    return {};
  }

  Result<void> face(std::string_view rest, std::uint64_t number) {
    if (patch_.empty()) return line_error(number, "a face outside of a group");
    Triangle triangle{};
    for (std::uint32_t& corner : triangle) {
      const std::string_view word = next_word(rest);
      std::uint64_t index = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
      if (word.empty() || error != std::errc{} || end != word.data() + word.size())
        return line_error(number, "expected a vertex number instead of " + in_quotes(word));
      if (index <= vertices_before_ || index > vertices_before_ + body_->points.size())
        return line_error(number, "vertex " + std::to_string(index) +
                                      " does not belong to object " + in_quotes(body_->name));
      corner = static_cast<std::uint32_t>(index - vertices_before_ - 1);
    }
    if (!next_word(rest).empty()) return line_error(number, "a face with more than three corners");
    body_->triangles.push_back(triangle);
    body_->patches.push_back(patch_);
    return {};
  }

  const ParsedBodySink& sink_;
  std::optional<ParsedBody> body_{};
  std::string patch_{};
  std::uint64_t vertices_before_ = 0;  // of earlier objects
};

template <class Input>
Result<void> parse(const Input& input, const ParsedBodySink& sink) {
  ObjReader reader(sink);
  auto read = for_each_line(input, [&reader](std::string_view text, std::uint64_t number) {
    return reader.line(text, number);
  });
  return read ? reader.end() : read;
}

}  // namespace

Result<void> parse_obj_text(std::string_view text, const ParsedBodySink& sink) {
  return parse(text, sink);
}

Result<void> parse_obj_file(const std::filesystem::path& file, const ParsedBodySink& sink) {
  return parse(file, sink);
}

}  // namespace citymesh
