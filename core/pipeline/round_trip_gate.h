#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/citymodel/issue.h"
#include "core/citymodel/mesh.h"
#include "core/citymodel/shell.h"
#include "core/pipeline/process_building.h"

namespace citymesh {

/// Judges shells as the files would hold them, in every open format, and keeps the mesh of the
/// shell it judged last.
class RoundTripGate {
 public:
  /// `name`: of the body, for messages.
  explicit RoundTripGate(const std::vector<OpenFormat>& formats, std::string name = "body")
      : formats_(formats), name_(std::move(name)) {}

  std::vector<Issue> operator()(const Shell& shell);

  TriangleMesh take_mesh() { return std::move(mesh_); }
  std::uint64_t fingerprint() const { return fingerprint_; }

  /// A format that cannot hold such coordinates at all, whatever the rung.
  const std::optional<Error>& refused() const { return refused_; }

 private:
  const std::vector<OpenFormat>& formats_;
  const std::string name_;
  TriangleMesh mesh_;
  std::uint64_t fingerprint_ = 0;
  std::optional<Error> refused_;
};

}  // namespace citymesh
