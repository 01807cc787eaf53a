#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/write/drawing.h"
#include "core/write/write.h"

namespace citymesh {

/// Pictures of the buildings that healing changed most, before and after: the lowest rungs first,
/// then the largest deviations. Memory and page are bounded by kMaxPictures of kMaxFaces.
class Gallery {
 public:
  static constexpr std::size_t kMaxPictures = 60;
  static constexpr std::size_t kMaxFaces = 1500;

  /// `bodies` is nullptr for a dropped building. Unchanged buildings are passed over.
  void add(const BuildingReport& report, const BuildingBodies* bodies,
           std::span<const SourceBody> sources);

  /// A section of the page, "" without pictures.
  std::string section() const;

 private:
  struct Rank {
    std::size_t rung = 0;
    double distance_m = 0;
    std::uint64_t order = 0;
    /// Milder, or later of the same.
    bool operator<(const Rank& other) const {
      return std::tuple(rung, distance_m, other.order) <
             std::tuple(other.rung, other.distance_m, order);
    }
  };
  struct Exhibit {
    Rank rank{};
    std::string caption{};  ///< HTML
    std::string label{};
    std::vector<DrawnFace> before{}, after{};
    std::vector<Point3> marks{};
  };

  std::vector<Exhibit> exhibits_{};  // a heap, the mildest first
  std::uint64_t changed_ = 0;
};

}  // namespace citymesh
