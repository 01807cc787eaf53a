#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/building.h"
#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/processes/inputs.h"
#include "core/write/write.h"

namespace citymesh {

/// A requested format and its open file.
struct OpenFormat {
  const Format* format = nullptr;
  std::unique_ptr<BodyWriter> writer{};
};

/// A building as it was read, with the names its bodies will have.
struct NamedBuilding {
  Building building{};
  std::string name{};
  std::vector<std::string> part_names{};  ///< of members_of()
  bool duplicate = false;                 ///< its id was seen before
};

struct ProcessedBuilding {
  BuildingReport report{};
  std::optional<BuildingBodies> bodies{};     ///< none when dropped
  std::vector<SourceBody> sources{};          ///< of what the report shows: see source_bodies.h
  std::vector<std::uint64_t> fingerprints{};  ///< signature of each body's triangles
  std::optional<Error> refused{};  ///< a format that cannot hold the building: the end of the run
};

/// What becomes bodies of their own besides the building: its parts, then, when they are kept, its
/// installations and those of its parts.
std::vector<const Building*> members_of(const Building& building, const Inputs& inputs);

/// Heals one building with its parts; every body passes the gates on its write-and-parse round trip
/// in every open format. An installation that cannot be healed is dropped alone. Touches nothing
/// but its arguments: buildings run side by side.
ProcessedBuilding process_building(const NamedBuilding& named, const Inputs& inputs,
                                   const std::vector<OpenFormat>& formats,
                                   const RunContext& context);

}  // namespace citymesh
