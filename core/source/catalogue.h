#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/source/area.h"
#include "core/source/document.h"

/// What is known of files before their buildings are read: found by a first pass (scan.h) and kept
/// in memory or in a database. Coordinates and axes are those of the file.
namespace citymesh::source {

/// Tells whether a file is still the one that was looked at.
struct FileStamp {
  std::int64_t time_ns = 0;
  std::uint64_t bytes = 0;
  bool operator==(const FileStamp&) const = default;

  /// None: the file is not there or cannot be looked at.
  static std::optional<FileStamp> of(const std::filesystem::path& path);
};

/// What a selection needs to know of a top-level building.
struct BuildingRecord {
  std::uint64_t number = 0;  ///< in its file, from 0
  std::string gml_id{};
  std::vector<std::string> part_ids{};
  Box3 extent{};          ///< empty: no geometry
  std::uint32_t srs = 0;  ///< of its first polygon
  Footprints footprint{};
  ByteRange bytes{};                    ///< unknown where the file cannot be read in pieces
  std::uint32_t envelope = 0;           ///< of the piece, index into DocumentFacts::envelopes
  std::uint32_t nth_of_piece = 0;       ///< where one piece holds several buildings
  std::vector<std::string> borrowed{};  ///< gml:id of geometry that other features have
};

/// The buildings of a file that use one of its CRS names.
struct SrsExtent {
  std::uint64_t buildings = 0;  ///< with geometry
  Box3 all{};
  Box3 near_m{}, near_deg{};  ///< without those astray, for coordinates in metres and in degrees
};

struct FileRecord {
  std::filesystem::path path{};    ///< as named by the user
  std::string name{};              ///< for reports: "a.gml", "tiles.zip/a.gml"
  bool found_in_folder = false;    ///< not named: what is no city model is passed over
  std::filesystem::path text{};    ///< where to read: `path`, or an unpacked copy
  std::optional<FileStamp> stamp;  ///< of `path` when it was looked at
  std::optional<Format> format{};  ///< none: not recognised, the reason is `facts.failure`
  DocumentFacts facts{};
  std::uint64_t buildings = 0;
  std::vector<SrsExtent> srs{};  ///< by index of DocumentFacts::srs_names
  std::map<std::string, SharedPlace, std::less<>> shared_places{};
  std::shared_ptr<const SharedGeometry> shared{};  ///< in memory: what `shared_places` lead to
};

/// A box in the coordinates of a file.
struct FlatBox {
  Point2 min{}, max{};

  /// Touching counts; an empty extent meets nothing.
  bool meets(const Box3& extent) const {
    return extent.min.x <= max.x && extent.max.x >= min.x && extent.min.y <= max.y &&
           extent.max.y >= min.y;
  }
};

/// Which buildings of a file are asked for; both conditions must hold.
struct RecordQuery {
  const std::unordered_set<std::string>* ids = nullptr;  ///< of buildings or parts; null: any
  std::optional<FlatBox> box{};                          ///< may also give some that do not meet it
  bool with_footprints = false;
};

using RecordSink = std::function<Result<void>(const BuildingRecord&)>;

class Catalogue {
 public:
  virtual ~Catalogue() = default;

  /// In reading order. `with_footprints`: queries will have a box.
  virtual Result<std::vector<std::shared_ptr<const FileRecord>>> files(
      bool with_footprints, const RunContext& context) = 0;

  /// In the order of their numbers.
  virtual Result<void> buildings(const FileRecord& file, const RecordQuery& query,
                                 const RecordSink& sink) = 0;
};

/// Chooses from a catalogue and reads what was chosen. Safe for several threads as far as the
/// catalogue is.
std::unique_ptr<CitySource> open_catalogue(std::shared_ptr<Catalogue> catalogue,
                                           FileSourceOptions options);

}  // namespace citymesh::source
