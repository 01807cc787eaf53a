#pragma once

#include <memory>
#include <span>

#include "core/write/glb_parts.h"

namespace citymesh {

/// errors.glb: the buildings as they came, grey, with faces in the colour of their gravest issue
/// and a small octahedron at the place of each; a node per body, its issues in the extras. What is
/// wider than GLB can hold, or comes after 1 GiB, is left out.
class ErrorsGlb {
 public:
  static Result<std::unique_ptr<ErrorsGlb>> create(const std::filesystem::path& folder,
                                                   const Scene& scene);

  Result<void> add(const BuildingReport& report, std::span<const SourceBody> sources);
  Result<void> finish();

 private:
  using File = SectionedFile<GlbParts::kSections>;
  ErrorsGlb(File file, const Scene& scene);

  File file_;
  GlbParts parts_;
};

}  // namespace citymesh
