#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/citymodel/crs.h"
#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/citymodel/shell.h"

namespace citymesh {

/// One line of the table of formats.
struct Format {
  std::string_view key;        ///< `obj`
  std::string_view file_name;  ///< `model.obj`
  std::string_view media_type;
  std::string_view sidecar;       ///< `model_binary.patches.json` or ""
  std::string_view title;         ///< what it is, for people
  bool gml_ids = false;           ///< bodies go by their gml_id, not by Body::name
  double bytes_per_triangle = 0;  ///< of a finished file with its sidecar: what cities take
};

std::span<const Format> formats();
const Format* find_format(std::string_view key);  ///< nullptr when not built
std::string format_keys();                        ///< "obj, stl, …" for messages

enum class Patches { ByObject, ByType };

/// What a file says about itself.
struct Scene {
  Crs crs{};
  Point3 origin{};
  std::string process{};
  Patches patches = Patches::ByObject;
};

/// An incremental sink for one file. Memory is bounded by a building; formats with gml_ids also
/// keep those they used. The file appears under its name when it is complete; an abandoned writer
/// leaves nothing. Origin, CRS, unit and axes stand in the header of OBJ and PLY, in the sidecar
/// (shortened: in the header) of binary STL, in the field data of VTU, the asset of GLB, the
/// metadata of CityJSON and the description of CityGML; ASCII STL has no place for them,
/// report.json has.
class BodyWriter {
 public:
  virtual ~BodyWriter() = default;

  /// The text of one building as it would stand in a file of its own (complete and readable; a
  /// sidecar follows the text). No side effects; may be called from several threads. Errors:
  /// FailedPrecondition when the format cannot hold the coordinates.
  virtual Result<std::string> encode(const BuildingBodies& building) const = 0;

  virtual Result<void> add(const BuildingBodies& building) = 0;

  /// Completes the file under its final name. Errors: Unavailable for a full or failing disk.
  virtual Result<void> finish() = 0;
};

Result<std::unique_ptr<BodyWriter>> open_writer(const Format& format,
                                                const std::filesystem::path& folder,
                                                const Scene& scene);

/// A body as its source has it, on the grid: for pictures of what healing changed.
struct SourceBody {
  std::string gml_id{};
  std::string name{};
  Shell shell{};
  std::vector<Issue> issues{};
};

/// report.json, report.html, picture.svg: fed building by building, completed by the totals;
/// errors.glb as well for `validate` and `heal`. Memory is bounded: the page has the first 5,000
/// buildings and before/after pictures of those that changed most, the picture draws large cities
/// as blocks.
class ReportWriter {
 public:
  static Result<std::unique_ptr<ReportWriter>> create(const std::filesystem::path& folder,
                                                      const Scene& scene);
  virtual ~ReportWriter() = default;

  /// `bodies` is nullptr for a dropped building, and when nothing is made of buildings: then the
  /// picture shows `sources`, coloured by their gravest issue.
  virtual Result<void> add(const BuildingReport& report, const BuildingBodies* bodies,
                           std::span<const SourceBody> sources) = 0;
  virtual Result<void> finish(const RunReport& report) = 0;
};

Result<void> write_run_json(const std::filesystem::path& folder, const RunTimings& timings);

}  // namespace citymesh
