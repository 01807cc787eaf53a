#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "core/gates/gates.h"

namespace citymesh {

// The readers behind parse_text and parse_file, one source file each.
Result<void> parse_obj_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_obj_file(const std::filesystem::path& file, const ParsedBodySink& sink);
Result<void> parse_stl_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_stl_file(const std::filesystem::path& file, const ParsedBodySink& sink);
Result<void> parse_binary_stl_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_binary_stl_file(const std::filesystem::path& file, const ParsedBodySink& sink);
Result<void> parse_cityjson_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_cityjson_file(const std::filesystem::path& file, const ParsedBodySink& sink);
Result<void> parse_cityjsonseq_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_cityjsonseq_file(const std::filesystem::path& file, const ParsedBodySink& sink);
Result<void> parse_citygml_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_citygml_file(const std::filesystem::path& file, const ParsedBodySink& sink);
Result<void> parse_ply_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_ply_file(const std::filesystem::path& file, const ParsedBodySink& sink);
Result<void> parse_vtu_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_vtu_file(const std::filesystem::path& file, const ParsedBodySink& sink);
Result<void> parse_glb_text(std::string_view text, const ParsedBodySink& sink);
Result<void> parse_glb_file(const std::filesystem::path& file, const ParsedBodySink& sink);

/// Takes a line without its end, and its number from 1.
using LineSink = std::function<Result<void>(std::string_view, std::uint64_t)>;

Result<void> for_each_line(std::string_view text, const LineSink& sink);
inline constexpr std::size_t kLongestLine = 1 << 20;  ///< of formats with short lines, in bytes

/// Reads in pieces. Errors: those of the sink; NotFound, Unavailable; DataLoss for a line longer
/// than anything a writer writes.
Result<void> for_each_line(const std::filesystem::path& file, const LineSink& sink,
                           std::size_t longest_line = kLongestLine);

/// Cuts the next word off `rest`; empty at the end of the line.
std::string_view next_word(std::string_view& rest);

/// DataLoss "line 12: <what>".
Error line_error(std::uint64_t line, std::string_view what);

/// A few characters of untrusted text for a message.
std::string in_quotes(std::string_view text);

/// Reads the three numbers that end a line. Errors: DataLoss.
Result<Point3> parse_point(std::string_view rest, std::uint64_t line);

/// "b_1__WallSurface" is patch WallSurface of body b_1; without "__": no body.
struct PatchName {
  std::string_view body{};
  std::string_view patch{};
};
PatchName split_patch_name(std::string_view name);

/// The error for a file that cannot be opened or read; `error` is errno.
Error file_error(const std::filesystem::path& file, int error);

}  // namespace citymesh
