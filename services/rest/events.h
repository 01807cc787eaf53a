#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "services/jobs/job.h"

namespace citymesh {

/// The changes of one job as server-sent events (WHATWG HTML, 9.2): one `status` per state that
/// is newer than the last one sent. The id of an event is `updated` of the job, so a client that
/// comes back gets what it has not seen; states in between are gone, the last one says it all.
class JobEvents {
 public:
  /// `last_event_id` as sent by a client that comes back; anything unknown counts as nothing seen.
  explicit JobEvents(std::string_view last_event_id);

  /// Whether the job is in a state that the client has not seen.
  bool has_news(const Job& job) const { return job.updated > seen_; }
  /// The event; empty without news. `rate_per_s` and `eta_s` are those of the stage since it was
  /// first seen here.
  std::string next(const Job& job);

 private:
  struct StageStart {
    std::string stage{};
    std::uint64_t done = 0;
    TimeMs time = 0;
  };

  TimeMs seen_ = -1;
  StageStart start_{};
};

}  // namespace citymesh
