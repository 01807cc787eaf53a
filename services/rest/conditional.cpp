#include "services/rest/conditional.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "services/rest/problem.h"

namespace citymesh {
namespace {

struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t bytes = 0;  ///< 0: it lies outside of the file
};

/// Digits only; what is too large for us is larger than any file.
std::optional<std::uint64_t> number(std::string_view digits) {
  std::uint64_t value = 0;
  const auto* end = digits.data() + digits.size();
  const auto parsed = std::from_chars(digits.data(), end, value);
  if (digits.empty() || parsed.ptr != end) return std::nullopt;
  return parsed.ec == std::errc{} ? value : std::numeric_limits<std::uint64_t>::max();
}

/// `bytes=0-99`, `bytes=100-` or `bytes=-100` of a file; nothing for everything else.
std::optional<ByteRange> parse_range(std::string_view range, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  if (!equal_without_case(range.substr(0, kUnit.size()), kUnit)) return std::nullopt;
  const auto items = list_items(range.substr(kUnit.size()));
  if (items.size() != 1) return std::nullopt;
  const auto dash = items[0].find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto from = number(items[0].substr(0, dash));
  const auto to = number(items[0].substr(dash + 1));
  if (dash == 0) {  // the last bytes
    if (!to) return std::nullopt;
    const auto bytes = std::min(*to, size);
    return ByteRange{size - bytes, bytes};
  }
  const bool open = dash + 1 == items[0].size();
  if (!from || (!to && !open) || (to && *to < *from)) return std::nullopt;
  if (*from >= size) return ByteRange{};
  return ByteRange{*from, std::min(to.value_or(size - 1), size - 1) - *from + 1};
}

/// Whether a list of entity tags names this one. The weak comparison takes `W/` for nothing.
bool names(std::string_view tags, std::string_view etag, bool weak) {
  return std::ranges::any_of(list_items(tags), [&](std::string_view tag) {
    if (weak && tag.starts_with("W/")) tag.remove_prefix(2);
    return tag == "*" || tag == etag;
  });
}

}  // namespace

Response conditional(const Request& request, Response whole, std::string_view accept) {
  const auto etag = whole.headers.get("ETag");
  if (whole.status != 200 || etag.empty() || whole.body.size() != 1 ||
      !std::holds_alternative<FilePiece>(whole.body[0]))
    return whole;
  whole.headers.set("Accept-Ranges", "bytes");

  const auto& asked = request.headers;
  const auto other = [&](Response response) {
    response.headers.set("ETag", etag);
    response.headers.set("Cache-Control", whole.headers.get("Cache-Control"));
    return response;
  };
  if (asked.has("If-Match") && !names(asked.get("If-Match"), etag, false))
    return other(problem_response(
        problems::kPreconditionFailed,
        fmt::format("the file is {}, expected {} (If-Match)", etag, asked.get("If-Match")),
        accept));
  if (names(asked.get("If-None-Match"), etag, true)) {
    Response unchanged;
    unchanged.status = 304;
    return other(std::move(unchanged));
  }

  // Only GET has ranges; of another version of the file they would not fit what the client has.
  if (request.method != "GET" || (asked.has("If-Range") && asked.get("If-Range") != etag))
    return whole;
  auto& file = std::get<FilePiece>(whole.body[0]);
  const auto size = file.bytes;
  const auto range = parse_range(asked.get("Range"), size);
  if (!range) return whole;
  if (range->bytes == 0) {
    auto outside =
        other(problem_response(problems::kRangeNotSatisfiable,
                               fmt::format("the range '{}' lies outside of the file of {} bytes",
                                           asked.get("Range"), size),
                               accept));
    outside.headers.set("Content-Range", fmt::format("bytes */{}", size));
    return outside;
  }
  whole.status = 206;
  whole.headers.set("Content-Range", fmt::format("bytes {}-{}/{}", range->first,
                                                 range->first + range->bytes - 1, size));
  file.bytes = range->bytes;
  file.read = [first = range->first, read = std::move(file.read)](std::uint64_t offset,
                                                                  std::uint64_t max_bytes) {
    return read(first + offset, max_bytes);
  };
  return whole;
}

}  // namespace citymesh
