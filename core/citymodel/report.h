#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/citymodel/building.h"
#include "core/citymodel/crs.h"
#include "core/citymodel/issue.h"
#include "core/geometry/point.h"

namespace citymesh {

/// What became of a building or part. Field names are those of report.json.
struct PartReport {
  std::string gml_id{};
  std::string name{};
  ObjectKind kind = ObjectKind::Building;
  std::string outcome{};  ///< delivered, merged, dropped
  std::string merged_into{};
  std::string reason{};  ///< set when dropped
  std::string lod{};
  std::string lane{};  ///< 2.5d, 3d
  std::string rung{};
  std::vector<Issue> issues_before{};
  std::vector<Issue> issues_after{};
  std::vector<Repair> repairs{};
  double max_displacement_m = 0;
  double deviation_max_m = 0;
  double deviation_mean_m = 0;
  std::optional<double> volume_before_m3{};  ///< none where the input is not closed
  double volume_after_m3 = 0;
  std::uint64_t triangles = 0;
};

struct BuildingReport : PartReport {
  std::vector<PartReport> parts{};  ///< its parts and the installations that were kept
};

struct Counts {
  std::uint64_t requested = 0, delivered = 0, merged = 0, dropped = 0;
};

struct InputReport {
  std::string file{};     ///< name without folder
  std::string format{};   ///< CityGML 2.0, CityJSON 2.0 …
  std::string state{};    ///< read, failed
  std::string message{};  ///< why it failed
  std::string crs{};
  std::uint64_t buildings = 0;  ///< top-level buildings found in it
};

/// Everything of report.json except buildings[].
struct RunReport {
  std::string process{};
  std::string version{};
  std::string options_json{};  ///< all options with the values used, a JSON object
  Crs crs{};
  std::vector<std::string> source_crs{};  ///< ids of the CRSs that the inputs use
  std::string vertical_crs{};  ///< name of the CRS of the heights; "" where none is stated
  Point3 origin{};
  std::vector<InputReport> inputs{};
  Counts counts{};
  Counts part_counts{};
  std::vector<std::string> warnings{};
  std::vector<std::pair<std::string, std::uint64_t>>
      rungs{};  ///< histogram over delivered buildings
  std::vector<std::pair<std::string, std::uint64_t>>
      drop_reasons{};  ///< histogram over dropped buildings
  std::vector<std::pair<std::string, std::uint64_t>>
      issues{};  ///< found in the input, by code; with those of parts
  std::uint64_t bodies = 0, points = 0, triangles = 0;
  std::optional<std::uint64_t>
      contacts{};  ///< pairs of bodies that touch or overlap; none: not counted
  double volume_m3 = 0, area_m2 = 0;
  double min_edge_m = 0, min_angle_deg = 0;
  Box3 extent{};  ///< of what was delivered, relative to `origin`
};

/// run.json: everything that may differ from run to run.
struct RunTimings {
  std::vector<std::pair<std::string, double>> stages_s{};
  double total_s = 0;
  unsigned threads = 1;
  std::string host{};
};

}  // namespace citymesh
