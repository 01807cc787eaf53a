#include "core/gates/parse.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace citymesh {
namespace {

constexpr std::size_t kPieceBytes = 1 << 20;

struct Parser {
  std::string_view format;
  Result<void> (*text)(std::string_view, const ParsedBodySink&);
  Result<void> (*file)(const std::filesystem::path&, const ParsedBodySink&);
};

constexpr std::array kParsers{
    Parser{"obj", parse_obj_text, parse_obj_file},
    Parser{"stl", parse_stl_text, parse_stl_file},
    Parser{"stl_binary", parse_binary_stl_text, parse_binary_stl_file},
    Parser{"ply", parse_ply_text, parse_ply_file},
    Parser{"vtu", parse_vtu_text, parse_vtu_file},
    Parser{"glb", parse_glb_text, parse_glb_file},
    Parser{"cityjson", parse_cityjson_text, parse_cityjson_file},
    Parser{"cityjsonseq", parse_cityjsonseq_text, parse_cityjsonseq_file},
    Parser{"citygml2", parse_citygml_text, parse_citygml_file},
    Parser{"citygml3", parse_citygml_text, parse_citygml_file},
};

Result<const Parser*> find_parser(std::string_view format) {
  for (const Parser& parser : kParsers)
    if (parser.format == format) return &parser;
  return fail(ErrorCode::Unimplemented,
              "format " + in_quotes(format) + " cannot be read back: it has no parser");
}

std::string_view without_carriage_return(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace

Result<void> parse_text(std::string_view format, std::string_view text,
                        const ParsedBodySink& sink) {
  const auto parser = find_parser(format);
  if (!parser) return parser.error();
  return parser.value()->text(text, sink);
}

Result<void> parse_file(std::string_view format, const std::filesystem::path& file,
                        const ParsedBodySink& sink) {
  const auto parser = find_parser(format);
  if (!parser) return parser.error();
  auto parsed = parser.value()->file(file, sink);
  if (parsed || parsed.error().code != ErrorCode::DataLoss) return parsed;
  return fail(ErrorCode::DataLoss, file.filename().string() + ": " + parsed.error().message);
}

Result<void> for_each_line(std::string_view text, const LineSink& sink) {
  for (std::uint64_t number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    if (auto taken = sink(without_carriage_return(line), number); !taken) return taken;
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return {};
}

Result<void> for_each_line(const std::filesystem::path& file, const LineSink& sink,
                           std::size_t longest_line) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"),
                                                               &std::fclose);
  if (!stream) return file_error(file, errno);
  std::string piece;
  std::uint64_t number = 0;
  for (bool at_end = false; !at_end;) {
    const std::size_t carried = piece.size();
    piece.resize(carried + kPieceBytes);
    const std::size_t got = std::fread(piece.data() + carried, 1, kPieceBytes, stream.get());
    if (std::ferror(stream.get()) != 0) return file_error(file, errno);
    at_end = got < kPieceBytes;
    piece.resize(carried + got);

    std::string_view rest = piece;
    while (!rest.empty()) {
      const auto end = rest.find('\n');
      if (end == std::string_view::npos && !at_end) break;
      if (auto taken = sink(without_carriage_return(rest.substr(0, end)), ++number); !taken)
        return taken;
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    if (rest.size() > longest_line)
      return line_error(number + 1, "longer than " + std::to_string(longest_line) + " bytes");
    piece.erase(0, piece.size() - rest.size());
  }
  return {};
}

std::string_view next_word(std::string_view& rest) {
  const auto begin = rest.find_first_not_of(" \t");
  if (begin == std::string_view::npos) {
    rest = {};
    return {};
  }
  rest.remove_prefix(begin);
  const auto end = std::min(rest.find_first_of(" \t"), rest.size());
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end);
  return word;
}

Error line_error(std::uint64_t line, std::string_view what) {
  return fail(ErrorCode::DataLoss, "line " + std::to_string(line) + ": " + std::string(what));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 60;
  std::string out = "\"";
  for (const char c : text.substr(0, kShown)) out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return out + (text.size() > kShown ? "…\"" : "\"");
}

Result<Point3> parse_point(std::string_view rest, std::uint64_t line) {
  std::array<double, 3> xyz{};
  for (double& value : xyz) {
    const std::string_view word = next_word(rest);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size())
      return line_error(line, "expected a number instead of " + in_quotes(word));
    if (!std::isfinite(value)) return line_error(line, in_quotes(word) + " is not finite");
  }
  if (!next_word(rest).empty()) return line_error(line, "more than three numbers");
  return Point3{xyz[0], xyz[1], xyz[2]};
}

PatchName split_patch_name(std::string_view name) {
  const auto cut = name.rfind("__");  // names of surface types hold no underscore
  if (cut == std::string_view::npos) return {{}, name};
  return {name.substr(0, cut), name.substr(cut + 2)};
}

Error file_error(const std::filesystem::path& file, int error) {
  return fail(
      error == ENOENT ? ErrorCode::NotFound : ErrorCode::Unavailable,
      "cannot read " + file.filename().string() + ": " + std::generic_category().message(error));
}

}  // namespace citymesh
