#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "core/base/result.h"
#include "core/processes/inputs.h"
#include "services/config/serve_options.h"
#include "services/jobs/write_back.h"
#include "services/telemetry/log.h"
#include "services/worker/run_offered.h"

namespace citymesh {

/// What the jobs of a service read.
struct ServedData {
  std::string name{};             ///< for people: a folder, or an address without secrets
  SourceFactory open{};           ///< within the limits of a job
  SourceFactory open_to_count{};  ///< the same for estimates, which never read
  /// Text that differs whenever what jobs read does; none: unknown.
  std::function<std::string()> version{};
  std::unique_ptr<WriteBackStore> write_back{};  ///< none: jobs cannot write back
  /// Refuses a box that is larger than it may be, and writing back where it cannot be.
  std::function<Result<void>(const Inputs& inputs)> check_inputs{};
};

/// A folder is opened through its catalogue, which is brought up to date now rather than in the
/// first job; a single file as it is; a database through its connections; a WFS by asking it.
/// Errors: those of what is opened.
Result<ServedData> open_served_data(const ServeOptions& options, Log& log,
                                    const std::stop_token& stop);

}  // namespace citymesh
