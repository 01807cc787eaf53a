#include "core/source/json_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

namespace citymesh::source {
namespace {

constexpr std::size_t kBuffer = 1u << 16;
constexpr std::size_t kMaxKey = 1u << 16;  // bytes of a member's name or of a number

// What matters to the nesting of values.
constexpr std::array<bool, 256> kStructural = [] {
  std::array<bool, 256> structural{};
  for (const char c : {'"', '{', '}', '[', ']'}) structural[static_cast<unsigned char>(c)] = true;
  return structural;
}();

bool is_blank(int c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

}  // namespace

/// Walks over the bytes of a slice, counting lines.
class JsonText::Cursor {
 public:
  static constexpr int kEnd = -1;

  Cursor(const RandomReader& file, const JsonSlice& slice)
      : file_(file), next_offset_(slice.begin), end_(slice.end), line_(slice.line) {}

  int peek() {
    if (at_ == filled_ && !fill()) return kEnd;
    return static_cast<unsigned char>(buffer_[at_]);
  }
  void advance() {
    if (buffer_[at_++] == '\n') ++line_;
  }
  int peek_solid() {
    int c = peek();
    while (is_blank(c)) {
      advance();
      c = peek();
    }
    return c;
  }
  /// To the next quote or bracket, or the end.
  void skip_to_structure() {
    do {
      for (; at_ < filled_; ++at_) {
        const auto c = static_cast<unsigned char>(buffer_[at_]);
        if (kStructural[c]) return;
        line_ += c == '\n';
      }
    } while (fill());
  }
  bool take(char wanted) {
    if (peek_solid() != wanted) return false;
    advance();
    return true;
  }
  /// Up to the closing quote; the opening one has been taken. `text` may be null.
  bool finish_string(std::string* text) {
    for (;;) {
      const int c = peek();
      if (c == kEnd) return false;
      advance();
      if (c == '"') return true;
      if (text) {
        if (text->size() >= kMaxKey) return false;
        text->push_back(static_cast<char>(c));
      }
      if (c == '\\') {
        const int escaped = peek();
        if (escaped == kEnd) return false;
        advance();
        if (text) text->push_back(static_cast<char>(escaped));
      }
    }
  }
  std::uint64_t offset() const { return next_offset_ - (filled_ - at_); }
  std::uint64_t line() const { return line_; }
  const std::optional<Error>& error() const { return error_; }

 private:
  bool fill() {
    const auto left = end_ - next_offset_;
    if (left == 0 || error_) return false;
    filled_ = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBuffer));
    at_ = 0;
    buffer_.resize(kBuffer);
    if (auto read = file_.read(next_offset_, filled_, buffer_.data()); !read) {
      error_ = read.error();
      filled_ = 0;
      return false;
    }
    next_offset_ += filled_;
    return true;
  }

  const RandomReader& file_;
  std::uint64_t next_offset_, end_;
  std::uint64_t line_;
  std::vector<char> buffer_{};
  std::size_t at_ = 0, filled_ = 0;
  std::optional<Error> error_{};
};

namespace {

template <class AnyCursor>
Error syntax_error(AnyCursor& cursor, const std::string& expected) {
  if (cursor.error()) return *cursor.error();
  const int c = cursor.peek_solid();
  const std::string found = c < 0      ? "the text ends"
                            : c < 0x80 ? std::string("found '") + static_cast<char>(c) + "'"
                                       : "found byte " + std::to_string(c);
  return fail(ErrorCode::DataLoss,
              "line " + std::to_string(cursor.line()) + ": " + found + ", expected " + expected);
}

template <class AnyCursor>
Result<void> skip_value(AnyCursor& cursor, unsigned max_depth) {
  std::vector<char> open;  // closing brackets that are due
  do {
    if (!open.empty()) cursor.skip_to_structure();
    const int c = cursor.peek_solid();
    if (c == AnyCursor::kEnd) return syntax_error(cursor, "a value");
    if (c == '"') {
      cursor.advance();
      if (!cursor.finish_string(nullptr)) return syntax_error(cursor, "the end of a string");
    } else if (c == '{' || c == '[') {
      cursor.advance();
      open.push_back(c == '{' ? '}' : ']');
      if (open.size() > max_depth)
        return fail(ErrorCode::ResourceExhausted,
                    "line " + std::to_string(cursor.line()) +
                        ": values are nested deeper than max_depth = " + std::to_string(max_depth));
    } else if (c == '}' || c == ']') {
      if (open.empty() || open.back() != c)
        return syntax_error(cursor,
                            open.empty() ? "a value" : std::string("'") + open.back() + "'");
      cursor.advance();
      open.pop_back();
    } else if (c == ',' || c == ':') {
      return syntax_error(cursor, "a value");
    } else {
      cursor.advance();
      for (int next = cursor.peek();
           next >= 0 && !is_blank(next) && next != ',' && next != '}' && next != ']';
           next = cursor.peek())
        cursor.advance();
    }
  } while (!open.empty());
  return {};
}

}  // namespace

JsonSlice JsonText::all() const {
  JsonSlice slice{0, file_.size(), 1};
  char mark[3] = {};
  if (slice.end >= 3 && file_.read(0, 3, mark) && mark[0] == '\xef' && mark[1] == '\xbb' &&
      mark[2] == '\xbf')
    slice.begin = 3;
  return slice;
}

Result<void> JsonText::members(const JsonSlice& object, std::vector<JsonMember>& members) const {
  Cursor cursor(file_, object);
  if (!cursor.take('{')) return syntax_error(cursor, "'{'");
  if (cursor.take('}')) return {};
  do {
    JsonMember member;
    if (!cursor.take('"')) return syntax_error(cursor, "a member name in quotes");
    if (!cursor.finish_string(&member.raw_key)) return syntax_error(cursor, "the end of a name");
    if (!cursor.take(':')) return syntax_error(cursor, "':'");
    cursor.peek_solid();
    member.value.begin = cursor.offset();
    member.value.line = cursor.line();
    if (auto skipped = skip_value(cursor, max_depth_); !skipped) return skipped;
    member.value.end = cursor.offset();
    members.push_back(std::move(member));
  } while (cursor.take(','));
  if (!cursor.take('}')) return syntax_error(cursor, "',' or '}'");
  if (cursor.peek_solid() != Cursor::kEnd) return syntax_error(cursor, "the end of the text");
  return {};
}

Result<void> JsonText::elements(const JsonSlice& array, std::vector<JsonSlice>& values) const {
  Cursor cursor(file_, array);
  if (!cursor.take('[')) return syntax_error(cursor, "'['");
  if (cursor.take(']')) return {};
  do {
    cursor.peek_solid();
    JsonSlice value{.begin = cursor.offset(), .line = cursor.line()};
    if (auto skipped = skip_value(cursor, max_depth_); !skipped) return skipped;
    value.end = cursor.offset();
    values.push_back(value);
  } while (cursor.take(','));
  if (!cursor.take(']')) return syntax_error(cursor, "',' or ']'");
  return {};
}

Result<void> JsonText::triples(const JsonSlice& array, std::uint64_t max_count,
                               std::vector<Point3>& triples) const {
  Cursor cursor(file_, array);
  std::string token;
  const auto number = [&](double& value) {
    token.clear();
    cursor.peek_solid();
    for (int c = cursor.peek();
         c >= 0 && !is_blank(c) && c != ',' && c != ']' && token.size() < kMaxKey;
         c = cursor.peek()) {
      token.push_back(static_cast<char>(c));
      cursor.advance();
    }
    // JSON's numbers start with a digit or a minus sign; from_chars would take "nan" and "inf".
    if (token.empty() || !(token[0] == '-' || (token[0] >= '0' && token[0] <= '9')) ||
        token.find_first_of("nN") != std::string::npos)
      return false;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();
    return error != std::errc::invalid_argument && end == token.data() + token.size();
  };

  if (!cursor.take('[')) return syntax_error(cursor, "'[' of the list of vertices");
  if (cursor.take(']')) return {};
  do {
    Point3 point;
    if (!cursor.take('[')) return syntax_error(cursor, "'[' of a vertex");
    if (!number(point.x) || !cursor.take(',') || !number(point.y) || !cursor.take(',') ||
        !number(point.z) || !cursor.take(']'))
      return syntax_error(cursor, "three numbers of vertex " + std::to_string(triples.size()));
    if (triples.size() >= max_count)
      return fail(ErrorCode::ResourceExhausted,
                  "more than " + std::to_string(max_count) + " vertices");
    triples.push_back(point);
  } while (cursor.take(','));
  if (!cursor.take(']')) return syntax_error(cursor, "',' or ']' after a vertex");
  return {};
}

Result<std::string> JsonText::text(const JsonSlice& slice, std::uint64_t max_bytes) const {
  const std::uint64_t size = slice.end - slice.begin;
  if (size > max_bytes)
    return fail(ErrorCode::ResourceExhausted,
                "line " + std::to_string(slice.line) + ": an object has " + std::to_string(size) +
                    " bytes, more than max_building_bytes = " + std::to_string(max_bytes));
  std::string text(static_cast<std::size_t>(size), '\0');
  if (auto read = file_.read(slice.begin, text.size(), text.data()); !read) return read.error();
  return text;
}

}  // namespace citymesh::source
