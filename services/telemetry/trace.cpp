#include "services/telemetry/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <random>

namespace citymesh {
namespace {

constexpr std::size_t kTraceIdAt = 3;    // behind the version
constexpr std::size_t kParentIdAt = 36;  // behind the id of the trace
constexpr std::size_t kFlagsAt = 53;
constexpr std::size_t kBytes = 55;

bool is_hexadecimal(std::string_view text) {
  return std::ranges::all_of(
      text, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

bool is_zero(std::string_view text) { return text.find_first_not_of('0') == text.npos; }

/// The version is followed by three parts whose lengths are given; later ones may say more behind.
bool is_valid(std::string_view header) {
  if (header.size() < kBytes) return false;
  const auto version = header.substr(0, 2);
  const auto trace_id = header.substr(kTraceIdAt, 32);
  const auto parent_id = header.substr(kParentIdAt, 16);
  const auto more = header.substr(kBytes);
  return is_hexadecimal(version) && version != "ff" && is_hexadecimal(trace_id) &&
         !is_zero(trace_id) && is_hexadecimal(parent_id) && !is_zero(parent_id) &&
         is_hexadecimal(header.substr(kFlagsAt, 2)) && header[kTraceIdAt - 1] == '-' &&
         header[kParentIdAt - 1] == '-' && header[kFlagsAt - 1] == '-' &&
         (more.empty() || (version != "00" && more.starts_with('-')));
}

std::uint64_t random_bits() {
  thread_local std::random_device source;
  return std::uniform_int_distribution<std::uint64_t>(1)(source);
}

}  // namespace

std::string trace_id_of(std::string_view traceparent) {
  if (is_valid(traceparent)) return std::string(traceparent.substr(kTraceIdAt, 32));
  return fmt::format("{:016x}{:016x}", random_bits(), random_bits());
}

}  // namespace citymesh
