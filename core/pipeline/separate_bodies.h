#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/run_context.h"
#include "core/citymodel/issue.h"
#include "core/citymodel/mesh.h"
#include "core/pipeline/process_building.h"
#include "core/reconstruct/share_space.h"

namespace citymesh {

/// How far corners of a body had to move out of another one.
struct Push {
  std::uint32_t from = 0;
  double displacement_m = 0;
  GridPoint at{};
};

/// What becomes of a body.
struct Separated {
  TriangleMesh mesh{};  ///< empty: others have all of its space
  std::uint64_t fingerprint = 0;
  std::vector<Issue> issues{};
  std::vector<Push> pushes{};
};

/// Two bodies that overlap after all.
struct Overlap {
  std::uint32_t a = 0, b = 0;
  Point3 at{};
};

struct SeparatedBodies {
  std::vector<std::optional<Separated>> bodies{};  ///< none: stays as it is
  std::vector<std::vector<SharedSpace>> spaces{};  ///< what each body gave to others
  std::vector<Overlap> overlaps{};
};

/// Makes the parts among the bodies of a building touch where they overlap. Corners that reach into
/// another part by a measuring error are pushed out of it (push_out.h); what overlaps by more is
/// cut and goes to one of them (share_space.h). Whatever changes has passed the delivery gates.
SeparatedBodies separate_bodies(const std::vector<Body>& bodies, const Inputs& inputs,
                                const std::vector<OpenFormat>& formats, const RunContext& context);

}  // namespace citymesh
