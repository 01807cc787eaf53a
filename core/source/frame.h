#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/citymodel/crs.h"
#include "core/source/area.h"
#include "core/source/catalogue.h"
#include "core/source/source.h"

namespace citymesh::source {

/// What has been asked of PROJ so far. Not thread-safe.
class CrsBook {
 public:
  const Result<CrsFacts>& facts(const Crs& crs);
  /// The transformation, x east and y north on both sides.
  const Result<Transformer>& transformer(const Crs& from, const Crs& to);
  /// To longitude and latitude of its own datum.
  const Result<Transformer>& to_degrees(const Crs& crs);

 private:
  std::map<std::string, Result<CrsFacts>> facts_{};
  std::map<std::pair<std::string, std::string>, Result<Transformer>> transformers_{};
  std::map<std::string, Result<Transformer>> to_degrees_{};
};

/// One CRS name of a file and how the file means it.
struct SrsUse {
  Crs crs{};
  bool swap_axes = false;
  std::string problem{};  ///< not empty: the name is not understood, nothing can be placed
  Box3 extent{};          ///< of the buildings that use it, axes turned; those far away left out
};

/// Reads the CRS names of a file and decides their axis order: geographic CRSs in the order
/// of the registry, projected ones east before north whatever the registry says; the other way
/// round where only that is plausible against the area of use. An `order` other than Auto is taken
/// as it is. `assumed` stands for no name.
std::vector<SrsUse> interpret_srs(const FileRecord& file, const Crs& assumed, AxisOrder order,
                                  CrsBook& book);

/// The boundary of what a request wants, moved by `transformer` unless that is null; sides have
/// points between their ends, because they bend. Errors: InvalidArgument where PROJ cannot.
Result<std::vector<Ring2>> rings_of(const RequestBox& box, const Transformer* transformer);

/// A box's ring, `kPointsPerSide` points on each side, counter-clockwise, not closed.
inline constexpr int kPointsPerSide = 21;
std::vector<Point3> densified_ring(double min_x, double min_y, double max_x, double max_y);

Box3 with_axes_swapped(Box3 box);

}  // namespace citymesh::source
