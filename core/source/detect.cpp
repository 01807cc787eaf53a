#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/text.h"
#include "core/source/byte_reader.h"
#include "core/source/document.h"
#include "core/source/soup.h"

namespace citymesh::source {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// The start of a file and, when it is asked for, the rest.
class Bytes {
 public:
  explicit Bytes(ByteReader reader) : reader_(std::move(reader)) {}

  Result<void> read_start() {
    while (filled_ < buffer_.size()) {
      const auto count = reader_.read(buffer_.data() + filled_, buffer_.size() - filled_);
      if (!count) return count.error();
      if (*count == 0) break;
      filled_ += *count;
    }
    return {};
  }
  std::string_view start() const { return {buffer_.data(), filled_}; }
  /// The piece behind the one before; empty at the end.
  Result<std::string_view> next() {
    const auto count = reader_.read(buffer_.data(), buffer_.size());
    if (!count) return count.error();
    return std::string_view(buffer_.data(), *count);
  }
  std::uint64_t bytes_read() const { return reader_.bytes_read(); }

 private:
  ByteReader reader_;
  std::array<char, 4096> buffer_{};
  std::size_t filled_ = 0;
};

/// Tells the JSON formats apart while the text passes by: the outermost member `type`, and whether
/// an object stands alone in the first line with another behind it.
class JsonKind {
 public:
  /// true when nothing can change any more.
  bool pass(std::string_view text) {
    for (const char c : text)
      if (step(c)) return true;
    return false;
  }
  Format format() const {
    if (type_ == "tu3djson") return Format::Tu3dJson;
    if (type_ == "Feature" || type_ == "FeatureCollection") return Format::JsonFg;
    return sequence_ ? Format::CityJsonSeq : Format::CityJson;
  }

 private:
  bool step(char c) {
    if (in_string_) {
      in_string(c);
      return false;
    }
    if (c == '\n' && last_ != 0 && !line_ended_) {
      line_ended_ = last_ == '}';
      // '}' at the end of the first line and '{' behind it cannot stand in one JSON text.
      no_sequence_ = !line_ended_;
    }
    if (is_blank(c)) return type_known() && no_sequence_;
    if (line_ended_ && !no_sequence_) {
      sequence_ = c == '{' && depth_ == 0;
      no_sequence_ = !sequence_;
      if (sequence_) return true;
    }
    last_ = c;
    if (c == '"') {
      in_string_ = true;
      text_.clear();
    } else if (c == '{' || c == '[') {
      ++depth_;
      is_key_ = c == '{';
    } else if (c == '}' || c == ']') {
      if (depth_ > 0) --depth_;
      is_key_ = false;
    } else if (c == ':') {
      is_key_ = false;
    } else if (c == ',') {
      is_key_ = depth_ == 1;
    }
    return type_known() && (no_sequence_ || other_format());
  }

  void in_string(char c) {
    if (std::exchange(escaped_, false)) return;
    if (c == '\\') escaped_ = true;
    if (c != '"') {
      if (text_.size() < 32) text_ += c;
      return;
    }
    in_string_ = false;
    last_ = '"';
    if (depth_ != 1 || type_known()) return;
    if (is_key_)
      key_is_type_ = text_ == "type";
    else if (std::exchange(key_is_type_, false))
      type_ = text_;
  }

  bool type_known() const { return !type_.empty(); }
  bool other_format() const { return format() == Format::Tu3dJson || format() == Format::JsonFg; }

  std::string type_{}, text_{};
  std::uint64_t depth_ = 0;
  bool in_string_ = false, escaped_ = false, is_key_ = false, key_is_type_ = false;
  char last_ = 0;
  bool line_ended_ = false, sequence_ = false, no_sequence_ = false;
};

Result<Format> json_format(Bytes& bytes, std::string_view text) {
  JsonKind kind;
  while (!text.empty() && !kind.pass(text)) {
    const auto next = bytes.next();
    if (!next) return next.error();
    text = *next;
  }
  return kind.format();
}

bool is_text(std::string_view bytes) {
  return std::none_of(bytes.begin(), bytes.end(),
                      [](char c) { return c >= 0 && c < ' ' && !is_blank(c) && c != '\f'; });
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string extension_of(std::filesystem::path path) {
  std::string extension = lower_case(path.extension().string());
  if (extension == ".gz") extension = lower_case(path.stem().extension().string());
  return extension;
}

// "OFF", "COFF", "STCN4nOFF"
bool starts_as_off(std::string_view text) {
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"})
    if (text.starts_with(prefix)) text.remove_prefix(prefix.size());
  return text.starts_with("OFF") && (text.size() == 3 || is_blank(text[3]));
}

// Every line is one of OBJ's, and one of them at least is more than a comment. The last one may be
// cut off.
bool looks_like_obj(std::string_view text) {
  constexpr std::string_view kKeywords[] = {"v", "vt", "vn",     "f",      "o",      "g", "s",
                                            "l", "p",  "mtllib", "usemtl", "usemap", "vp"};
  bool any = false;
  for (auto end = text.find('\n'); end != text.npos; end = text.find('\n')) {
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    const auto keyword = next_word(line);
    if (keyword.empty() || keyword.front() == '#') continue;
    if (std::find(std::begin(kKeywords), std::end(kKeywords), keyword) == std::end(kKeywords))
      return false;
    if (keyword == "v" && !point_from(line)) return false;
    any = true;
  }
  return any;
}

// The header of binary STL may begin with "solid" too.
bool looks_like_stl_text(std::string_view text) {
  if (lower_case(std::string(text.substr(0, 5))) != "solid" || !is_text(text)) return false;
  const std::string lower = lower_case(std::string(text));
  return lower.find("facet") != lower.npos || lower.find("endsolid") != lower.npos;
}

// 84 bytes and 50 for each of the triangles that they state.
Result<bool> has_size_of_stl(Bytes& bytes) {
  const std::string_view start = bytes.start();
  if (start.size() < 84) return false;
  std::uint64_t triangles = 0;
  for (std::size_t i = 84; i-- > 80;)
    triangles = triangles << 8 | static_cast<unsigned char>(start[i]);
  const std::uint64_t size = 84 + 50 * triangles;
  while (bytes.bytes_read() <= size) {
    const auto next = bytes.next();
    if (!next) return next.error();
    if (next->empty()) break;
  }
  return bytes.bytes_read() == size;
}

Error unknown_format(std::string_view start) {
  return fail(ErrorCode::InvalidArgument,
              std::string(start.starts_with("PK") ? "the file is a zip archive"
                                                  : "the format of the file is unknown") +
                  ", expected CityGML, CityJSON, JSON-FG, tu3djson, OBJ, OFF, PLY, POLY or STL, "
                  "plain or .gz");
}

}  // namespace

Result<Format> detect_format(const std::filesystem::path& path, const std::string& name,
                             const ReadLimits& limits) {
  auto reader = ByteReader::open(path, limits.max_file_bytes);
  if (!reader) return reader.error();
  Bytes bytes(std::move(*reader));
  if (auto read = bytes.read_start(); !read) return read.error();
  const std::string_view start = bytes.start();
  std::string_view text = start;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  if (text.empty()) return fail(ErrorCode::InvalidArgument, "the file is empty");

  const bool utf16 = text.starts_with("\xfe\xff") || text.starts_with("\xff\xfe");
  if (text.front() == '<' || utf16) return Format::CityGml;
  if (text.front() == '{') return json_format(bytes, text);
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return Format::Ply;
  if (starts_as_off(text)) return Format::Off;
  if (looks_like_stl_text(text)) return Format::StlText;
  if (is_text(start)) {
    if (looks_like_obj(text)) return Format::Obj;
    // Nothing but numbers or comments: the name has to tell.
    const std::string extension = extension_of(name);
    if (extension == ".obj") return Format::Obj;
    if (extension == ".off") return Format::Off;
    if (extension == ".poly") return Format::Poly;
    if (extension == ".stl") return Format::StlText;
  } else {
    const auto fits = has_size_of_stl(bytes);
    if (!fits) return fits.error();
    if (*fits || extension_of(name) == ".stl") return Format::StlBinary;
  }
  return unknown_format(start);
}

}  // namespace citymesh::source
