#pragma once

#include <functional>

#include "services/config/serve_options.h"

namespace CLI {
class App;
}

namespace citymesh {

/// Adds the command `serve`. Its settings come, from low to high, from defaults, from section
/// `[serve]` of the TOML file that `--config` names, from the environment (`CITYMESH_MAX_OPEN_JOBS`
/// for `--max_open_jobs`) and from flags. `run` is called when `options` are complete.
void add_serve(CLI::App& program, ServeOptions& options, std::function<void()> run);

}  // namespace citymesh
