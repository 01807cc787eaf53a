#include "services/rest/events.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "services/rest/documents.h"

namespace citymesh {
namespace {

double rounded(double value) { return std::round(value * 10) / 10; }

}  // namespace

JobEvents::JobEvents(std::string_view last_event_id) {
  TimeMs time = 0;
  const auto* end = last_event_id.data() + last_event_id.size();
  const auto parsed = std::from_chars(last_event_id.data(), end, time);
  if (!last_event_id.empty() && parsed.ec == std::errc{} && parsed.ptr == end) seen_ = time;
}

std::string JobEvents::next(const Job& job) {
  if (!has_news(job)) return {};
  seen_ = job.updated;
  const auto& progress = job.progress;
  if (progress.stage != start_.stage || progress.done < start_.done)
    start_ = {progress.stage, progress.done, job.updated};

  nlohmann::ordered_json data = {{"jobID", job.id},
                                 {"status", to_string(job.state)},
                                 {"progress", job.percent},
                                 {"message", job.message},
                                 {"updated", rfc3339(job.updated)}};
  if (!progress.stage.empty() && job.state == JobState::Running) {
    data["stage"] = progress.stage;
    data["done"] = progress.done;
    data["total"] = progress.total;
    const auto seconds = static_cast<double>(job.updated - start_.time) / 1000.0;
    const auto done = static_cast<double>(progress.done - start_.done);
    if (seconds > 0 && done > 0) {
      data["rate_per_s"] = rounded(done / seconds);
      if (progress.total >= progress.done)
        data["eta_s"] =
            rounded(static_cast<double>(progress.total - progress.done) * seconds / done);
    }
  }
  return fmt::format("id: {}\nevent: status\ndata: {}\n\n", job.updated,
                     data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace citymesh
