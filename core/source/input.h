#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/source/byte_reader.h"

namespace citymesh::source {

/// A file taken line by line or byte by byte, also in turns.
class Input {
 public:
  /// Lines longer than `max_line_bytes` are refused.
  Input(ByteReader& bytes, std::uint64_t max_line_bytes)
      : bytes_(bytes), max_line_bytes_(max_line_bytes) {}

  /// The next line without its end; the last one may lack it. false at the end of the file. Errors:
  /// as ByteReader; ResourceExhausted for a line that is too long.
  Result<bool> next_line(std::string& line);

  /// Exactly `size` bytes; false when the file ends before. Errors: as ByteReader.
  Result<bool> take(char* to, std::size_t size);

  std::uint64_t line() const { return line_; }      ///< number of the line taken last, from 1
  std::uint64_t offset() const { return offset_; }  ///< bytes taken so far

 private:
  Result<bool> fill();

  ByteReader& bytes_;
  std::uint64_t max_line_bytes_;
  std::vector<char> buffer_{};
  std::size_t at_ = 0, filled_ = 0;
  std::uint64_t line_ = 0, offset_ = 0;
};

}  // namespace citymesh::source
