#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>

#include "core/citymodel/building.h"
#include "core/citymodel/mesh.h"
#include "core/citymodel/report.h"
#include "core/pipeline/contacts.h"

namespace citymesh {

/// Adds up what report.json says of the whole run.
class Totals {
 public:
  /// `bodies` is nullptr for a dropped building.
  void add(const BuildingReport& building, const BuildingBodies* bodies);

  /// What was left out of a building by choice.
  void add_skipped(const Building& building);
  void keep_installations() { keep_installations_ = true; }

  RunReport finish();

  RunReport& report() { return report_; }

 private:
  void add(const TriangleMesh& mesh);

  RunReport report_;
  Contacts contacts_;
  bool keep_installations_ = false;
  std::uint64_t installations_ = 0;  ///< left out
  std::map<std::string, std::uint64_t> ade_elements_;
  std::map<std::string, std::uint64_t> rungs_, reasons_, issues_;
  double min_edge_m_ = std::numeric_limits<double>::infinity();
  double max_cosine_ = -1;
};

}  // namespace citymesh
