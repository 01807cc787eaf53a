#include "services/rest/job_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <string_view>
#include <vector>

namespace citymesh {
namespace {

using Query = std::map<std::string, std::string>;

constexpr std::uint32_t kDefaultLimit = 100;
constexpr std::uint32_t kMaxLimit = 1000;
constexpr std::uint32_t kMaxOffset = 1'000'000'000;

Error wrong(std::string_view name, std::string_view value, std::string_view expected) {
  return fail(ErrorCode::InvalidArgument,
              fmt::format("query parameter `{}` is '{}', expected {}", name, value, expected));
}

std::vector<std::string> comma_list(std::string_view text) {
  std::vector<std::string> items;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find(',', begin), text.size());
    if (end > begin) items.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return items;
}

std::optional<int> digits(std::string_view text, std::size_t begin, std::size_t count) {
  if (begin + count > text.size()) return std::nullopt;
  int number = 0;
  const auto* first = text.data() + begin;
  if (*first < '0' || *first > '9') return std::nullopt;
  const auto parsed = std::from_chars(first, first + count, number);
  if (parsed.ec != std::errc{} || parsed.ptr != first + count) return std::nullopt;
  return number;
}

/// RFC 3339 with Z or a numeric offset, or a date alone (its first moment).
std::optional<TimeMs> parse_time(std::string_view text) {
  const auto year = digits(text, 0, 4), month = digits(text, 5, 2), day = digits(text, 8, 2);
  if (!year || !month || !day || text[4] != '-' || text[7] != '-') return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok()) return std::nullopt;
  auto time =
      static_cast<TimeMs>(std::chrono::sys_days{date}.time_since_epoch().count()) * 86400000;
  if (text.size() == 10) return time;

  const auto hour = digits(text, 11, 2), minute = digits(text, 14, 2), second = digits(text, 17, 2);
  if (!hour || !minute || !second || (text[10] != 'T' && text[10] != 't') || text[13] != ':' ||
      text[16] != ':' || *hour > 23 || *minute > 59 || *second > 60)
    return std::nullopt;
  time += ((*hour * 60LL + *minute) * 60 + *second) * 1000;

  std::size_t at = 19;
  if (at < text.size() && text[at] == '.') {
    TimeMs scale = 100;
    for (++at; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at, scale /= 10)
      time += (text[at] - '0') * scale;
  }
  const auto zone = text.substr(at);
  if (zone == "Z" || zone == "z") return time;
  const auto zone_hour = digits(zone, 1, 2), zone_minute = digits(zone, 4, 2);
  if (zone.size() != 6 || !zone_hour || !zone_minute || zone[3] != ':' ||
      (zone[0] != '+' && zone[0] != '-'))
    return std::nullopt;
  const TimeMs shift = (*zone_hour * 60LL + *zone_minute) * 60000;
  return zone[0] == '+' ? time - shift : time + shift;
}

Result<void> parse_datetime(std::string_view text, JobQuery& parsed) {
  constexpr std::string_view kExpected =
      "an RFC 3339 time or an interval from/to, open ends as '..' or empty";
  const auto slash = text.find('/');
  const auto from = text.substr(0, slash);
  const auto to = slash == std::string_view::npos ? from : text.substr(slash + 1);
  const auto read = [](std::string_view end, std::optional<TimeMs>& time) {
    if (end.empty() || end == "..") return true;
    time = parse_time(end);
    return time.has_value();
  };
  if (!read(from, parsed.created_from) || !read(to, parsed.created_to) ||
      (slash == std::string_view::npos && !parsed.created_from))
    return wrong("datetime", text, kExpected);
  return {};
}

Result<std::optional<double>> seconds(const Query& query, const std::string& name) {
  const auto found = query.find(name);
  if (found == query.end()) return std::optional<double>{};
  const auto& text = found->second;
  double value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size() ||
      !std::isfinite(value) || value < 0)
    return wrong(name, text, "a number of seconds, 0 or more");
  return std::optional<double>{value};
}

}  // namespace

Result<std::uint32_t> whole_number(const Query& query, const std::string& name,
                                   std::uint32_t fallback, std::uint32_t minimum,
                                   std::uint32_t maximum) {
  const auto found = query.find(name);
  if (found == query.end()) return fallback;
  const auto& text = found->second;
  std::uint32_t value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size() || value < minimum ||
      value > maximum)
    return wrong(name, text, fmt::format("a whole number from {} to {}", minimum, maximum));
  return value;
}

Result<void> check_parameters(const Query& query, std::initializer_list<std::string_view> known) {
  for (const auto& [name, value] : query)
    if (name != "f" && std::ranges::find(known, name) == known.end())
      return fail(ErrorCode::InvalidArgument,
                  fmt::format("query parameter `{}` is not known here; known: {}{}f", name,
                              fmt::join(known, ", "), known.size() > 0 ? ", " : ""));
  return {};
}

Result<JobQuery> parse_job_query(const Query& query) {
  if (auto checked = check_parameters(query, {"limit", "offset", "type", "processID", "status",
                                              "datetime", "minDuration", "maxDuration"});
      !checked)
    return checked.error();

  JobQuery parsed;
  const auto limit = whole_number(query, "limit", kDefaultLimit, 1, kMaxLimit);
  if (!limit) return limit.error();
  parsed.filter.limit = *limit;
  const auto offset = whole_number(query, "offset", 0, 0, kMaxOffset);
  if (!offset) return offset.error();
  parsed.filter.offset = *offset;

  if (const auto type = query.find("type"); type != query.end())
    for (const auto& item : comma_list(type->second))
      if (item != "process") return wrong("type", item, "process");
  if (const auto process = query.find("processID"); process != query.end())
    parsed.filter.processes = comma_list(process->second);
  if (const auto status = query.find("status"); status != query.end())
    for (const auto& item : comma_list(status->second)) {
      const auto state = job_state_from(item);
      if (!state)
        return wrong("status", item, "accepted, running, successful, failed or dismissed");
      parsed.filter.states.push_back(*state);
    }
  if (const auto datetime = query.find("datetime"); datetime != query.end())
    if (auto read = parse_datetime(datetime->second, parsed); !read) return read.error();

  const auto shortest = seconds(query, "minDuration");
  if (!shortest) return shortest.error();
  parsed.min_duration_s = *shortest;
  const auto longest = seconds(query, "maxDuration");
  if (!longest) return longest.error();
  parsed.max_duration_s = *longest;
  return parsed;
}

bool selects(const JobQuery& query, const Job& job, TimeMs now) {
  if (query.created_from && job.created < *query.created_from) return false;
  if (query.created_to && job.created > *query.created_to) return false;
  if (!query.min_duration_s && !query.max_duration_s) return true;
  if (!job.started) return false;
  const double duration_s = static_cast<double>(job.finished.value_or(now) - *job.started) / 1000.0;
  return duration_s >= query.min_duration_s.value_or(0) &&
         duration_s <= query.max_duration_s.value_or(std::numeric_limits<double>::infinity());
}

}  // namespace citymesh
