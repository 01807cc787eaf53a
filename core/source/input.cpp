#include "core/source/input.h"

#include <algorithm>

namespace citymesh::source {

Result<bool> Input::fill() {
  constexpr std::size_t kBuffer = 1u << 16;
  buffer_.resize(kBuffer);
  const auto count = bytes_.read(buffer_.data(), buffer_.size());
  if (!count) return count.error();
  at_ = 0;
  filled_ = *count;
  return filled_ > 0;
}

Result<bool> Input::next_line(std::string& line) {
  line.clear();
  ++line_;
  bool any = false;
  for (;;) {
    if (at_ == filled_) {
      const auto more = fill();
      if (!more) return more.error();
      if (!*more) return any;
    }
    any = true;
    const auto begin = buffer_.begin() + static_cast<std::ptrdiff_t>(at_);
    const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(filled_);
    const auto found = std::find(begin, end, '\n');
    line.append(begin, found);
    const auto taken = static_cast<std::size_t>(found - begin) + (found == end ? 0 : 1);
    at_ += taken;
    offset_ += taken;
    if (line.size() > max_line_bytes_)
      return fail(ErrorCode::ResourceExhausted, "line " + std::to_string(line_) +
                                                    " has more than max_building_bytes = " +
                                                    std::to_string(max_line_bytes_) + " bytes");
    if (found != end) return true;
  }
}

Result<bool> Input::take(char* to, std::size_t size) {
  while (size > 0) {
    if (at_ == filled_) {
      const auto more = fill();
      if (!more || !*more) return more;
    }
    const std::size_t count = std::min(size, filled_ - at_);
    to = std::copy_n(buffer_.data() + at_, count, to);
    at_ += count;
    offset_ += count;
    size -= count;
  }
  return true;
}

}  // namespace citymesh::source
