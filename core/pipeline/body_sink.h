#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/citymodel/mesh.h"

namespace citymesh {

struct Scene;

/// Takes what a run delivers, beside its files. An error ends the run.
class BodySink {
 public:
  virtual ~BodySink() = default;

  /// Before everything else. Errors: what cannot be taken as it will come.
  virtual Result<void> begin(const Scene& scene) = 0;
  virtual Result<void> add(const BuildingBodies& building) = 0;
  /// Everything was added. What is to be warned of, for the report.
  virtual Result<std::vector<std::string>> finish() = 0;
};

}  // namespace citymesh
