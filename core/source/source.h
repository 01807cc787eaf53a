#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/run_context.h"
#include "core/citymodel/building.h"
#include "core/citymodel/crs.h"
#include "core/citymodel/report.h"

namespace citymesh {

enum class BboxRule { Intersects, Centre, Within };

/// How files store their coordinates. Auto: as interpret_srs() finds out.
enum class AxisOrder { Auto, EastNorth, NorthEast };

/// A box, or a region with the box around it, as a request states it: axis order of the named CRS
/// already turned to x east, y north.
struct RequestBox {
  double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  std::optional<std::array<double, 2>> z_range_m{};
  Crs crs{"OGC:CRS84"};
  /// Of the region, not closed; what is inside goes by the even-odd rule. Empty: the whole box.
  std::vector<std::vector<std::array<double, 2>>> rings{};
};

/// What to take from a source. No box and no ids: everything.
struct BuildingQuery {
  std::optional<RequestBox> bbox{};
  BboxRule bbox_rule = BboxRule::Intersects;
  std::vector<std::string> object_ids{};  ///< with a box: both must hold
  Crs crs{};                              ///< working CRS wanted; empty: the source's
  Crs source_crs{};                       ///< of files that state none
  AxisOrder axis_order = AxisOrder::Auto;
};

/// The frame and the extent of a selection, found before the first building is read.
struct Selection {
  Crs crs{};                              ///< working CRS: projected, metres
  std::vector<std::string> source_crs{};  ///< ids of the CRSs that the inputs use, each once
  /// Whole metres (floored), never from the features found. With a box: its centre, z 0. Else the
  /// lower corner of the extents that the files declare; a file that declares none, or one that its
  /// buildings contradict, counts with the extent of all its buildings, those further than 200 km
  /// from their median left out. Points beyond 214 km of it are issue C105.
  Point3 origin{};
  std::uint64_t buildings = 0;  ///< top-level buildings that `read` will deliver
  /// Of their outer shells, by how much the source keeps of them; right within a factor of three
  /// for most. None: the source cannot tell without reading.
  std::optional<std::uint64_t> expected_triangles{};
  std::vector<InputReport> inputs{};  ///< one per file or store, in reading order
  std::vector<std::string> warnings{};
  std::vector<std::string> missing_ids{};  ///< of `object_ids`, those no source has
  std::vector<std::string>
      object_ids{};  ///< gml_id of every selected building, part and installation, in reading
                     ///< order, repeated ids included; from these names are made before anything is
                     ///< written
  std::shared_ptr<const void> details{};  ///< for the source that made it
};

/// Takes one top-level building with its parts. Returning an error ends the reading with it.
using BuildingSink = std::function<Result<void>(Building&&)>;

/// Somewhere city models are kept: a folder of files, a database, a WFS.
class CitySource {
 public:
  virtual ~CitySource() = default;

  /// Errors: InvalidArgument for a box that cannot be transformed or a CRS that does not fit the
  /// data; FailedPrecondition when the selected features disagree on the CRS and none is asked for
  /// (lists them). An unreadable file is an InputReport with state `failed`, not an error.
  virtual Result<Selection> select(const BuildingQuery& query, const RunContext& context) = 0;

  /// Delivers the buildings of the selection in (file, offset) order. A building that cannot be
  /// read is delivered without geometry and with the reason in `source_issues`.
  virtual Result<void> read(const BuildingQuery& query, const Selection& selection,
                            const BuildingSink& sink, const RunContext& context) = 0;
};

/// Limits of the readers; what exceeds them is refused with a message that names the limit.
struct ReadLimits {
  std::uint32_t max_depth = 256;  ///< nesting of XML elements or JSON values
  std::uint64_t max_file_bytes = 64ull << 30;
  std::uint64_t max_building_bytes = 512ull << 20;  ///< source text of one top-level feature
  std::uint64_t max_points_per_building = 20'000'000;
};

struct FileSourceOptions {
  ReadLimits limits{};
  Crs assume_crs{};  ///< for files that state none
};

/// CityGML 1.0, 2.0, 3.0, CityJSON(Seq) 1.0, 1.1, 2.0, JSON-FG, tu3djson, OBJ, OFF, PLY, POLY and
/// STL files (also .gz), found by content; see docs/formats.md. Directories are searched one level
/// deep, in the order of names; what is no city model in them is passed over with a warning. What a
/// first pass finds is kept until the file changes. Files that state no CRS are taken to be in the
/// query's `source_crs`, else in its `crs`. Thread-safe. Errors: NotFound for a path that does not
/// exist, PermissionDenied for one that cannot be read.
Result<std::unique_ptr<CitySource>> open_files(std::vector<std::filesystem::path> paths,
                                               FileSourceOptions options);

}  // namespace citymesh
