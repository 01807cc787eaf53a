#include <chrono>

#include "services/rest/answers.h"
#include "services/rest/api.h"
#include "services/rest/events.h"

namespace citymesh {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongestStream_s = 3600;            // the client comes back by itself
constexpr auto kSilence = std::chrono::seconds(15);  // below the patience of proxies
constexpr std::string_view kStillHere = ": still here\n\n";
constexpr std::string_view kRetry = "retry: 2000\n\n";

}  // namespace

Response Api::events(const Call& call) const {
  const auto job = find_job(call);
  if (!job) return job_error(job.error(), call.accept);
  JobEvents events(call.request.headers.get("Last-Event-ID"));
  Response response;
  if (is_final(job->state) && !events.has_news(*job)) {
    response.status = 204;  // tells the client not to come back
    return response;
  }
  response.headers.set("Content-Type", "text/event-stream");
  response.headers.set("X-Accel-Buffering", "no");
  Follow follow;
  follow.job_id = job->id;
  follow.streams = true;
  follow.longest_s = kLongestStream_s;
  follow.step = [this, id = job->id, events = std::move(events), sent = Clock::now(),
                 begun = false](bool) mutable {
    FollowStep step;
    if (!begun) step.bytes = kRetry;
    begun = true;
    const auto now = jobs_.get(id);
    if (!now) {
      step.end = true;  // it is gone
      return step;
    }
    step.bytes += events.next(*now);
    if (step.bytes.empty() && Clock::now() - sent > kSilence) step.bytes = kStillHere;
    if (!step.bytes.empty()) sent = Clock::now();
    step.end = is_final(now->state);
    return step;
  };
  response.follow = std::move(follow);
  return response;
}

}  // namespace citymesh
