#include "services/jobs/job.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <utility>

namespace citymesh {
namespace {

constexpr std::array<std::pair<JobState, std::string_view>, 5> kStates{{
    {JobState::Accepted, "accepted"},
    {JobState::Running, "running"},
    {JobState::Successful, "successful"},
    {JobState::Failed, "failed"},
    {JobState::Dismissed, "dismissed"},
}};

}  // namespace

std::string_view to_string(JobState state) {
  for (const auto& [known, name] : kStates)
    if (known == state) return name;
  return "failed";
}

std::optional<JobState> job_state_from(std::string_view name) {
  for (const auto& [state, known] : kStates)
    if (known == name) return state;
  return std::nullopt;
}

Result<void> check_idempotency_key(std::string_view key) {
  constexpr std::size_t kLongest = 255;
  const bool plain = std::ranges::all_of(
      key, [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; });
  if (!key.empty() && key.size() <= kLongest && plain) return {};
  return fail(ErrorCode::InvalidArgument,
              fmt::format("the idempotency key is '{}', expected 1 to {} printable ASCII "
                          "characters without quotes and backslashes, for instance a UUID",
                          key.substr(0, kLongest), kLongest));
}

TimeMs now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

std::string new_job_id() {
  std::array<unsigned char, 16> bytes{};
  // Job ids are the only key to a job: no fallback to a weaker source.
  if (getentropy(bytes.data(), bytes.size()) != 0) std::abort();
  bytes[6] = static_cast<unsigned char>((bytes[6] & 0x0f) | 0x40);  // version 4
  bytes[8] = static_cast<unsigned char>((bytes[8] & 0x3f) | 0x80);  // variant of RFC 4122

  constexpr std::string_view kHex = "0123456789abcdef";
  std::string id;
  id.reserve(36);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i == 4 || i == 6 || i == 8 || i == 10) id += '-';
    id += kHex[bytes[i] >> 4];
    id += kHex[bytes[i] & 0x0f];
  }
  return id;
}

}  // namespace citymesh
