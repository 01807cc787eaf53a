#include "services/worker/result_cache.h"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <array>

#include "core/processes/inputs.h"
#include "services/offer/echo.h"

namespace citymesh {

std::string cache_key(const Job& job, std::string_view source_version, bool shared,
                      std::string_view program) {
  if (source_version.empty() || job.spec.process == kEcho ||
      asks_to_write_back(job.spec.inputs_json))
    return {};
  std::string text;
  // With their lengths, so that no two lists of parts give the same text.
  for (const std::string_view part :
       {program, std::string_view(job.spec.process), std::string_view(job.spec.inputs_json),
        source_version, shared ? std::string_view("of all") : std::string_view("of"),
        shared ? std::string_view() : std::string_view(job.owner)})
    text += fmt::format("{}:{}", part.size(), part);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  std::string key;
  for (const auto byte : digest) key += fmt::format("{:02x}", byte);
  return key;
}

std::optional<Job> reuse_results(JobStore& jobs, ResultStore& results, const std::string& cache_key,
                                 const Claim& claim) {
  auto earlier = jobs.get_by_cache_key(cache_key);
  if (!earlier) return std::nullopt;
  // They may be swept at this moment: then the job is worked on like any other.
  if (!results.reuse(earlier->id, earlier->results, claim.job_id, claim.attempt))
    return std::nullopt;
  return *std::move(earlier);
}

}  // namespace citymesh
