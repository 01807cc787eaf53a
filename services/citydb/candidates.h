#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/source/catalogue.h"
#include "core/source/frame.h"
#include "services/citydb/schema.h"

namespace citymesh::citydb {

/// What the choice of buildings needs to know of a database, in the form in which it knows files:
/// one record for the whole database. For one selection.
class DatabaseCatalogue final : public source::Catalogue {
 public:
  /// `name`: for reports. All must outlive the catalogue.
  DatabaseCatalogue(postgres::Connection& connection, const Schema& schema,
                    const Instance& instance, std::string name, std::uint32_t chunk,
                    const BuildingQuery& query, const ReadLimits& limits);

  Result<std::vector<std::shared_ptr<const source::FileRecord>>> files(
      bool with_footprints, const RunContext& context) override;
  /// BuildingRecord::number is the id of the building's row. With a box those inside of it have
  /// their envelope for a footprint: only what crosses its border is read for a true one.
  Result<void> buildings(const source::FileRecord& file, const source::RecordQuery& query,
                         const source::RecordSink& sink) override;

  const source::DocumentFacts& facts() const { return facts_; }

 private:
  Result<std::vector<Candidate>> candidates(const source::RecordQuery& query);
  Result<void> add_members(std::vector<source::BuildingRecord>& records);
  Result<void> add_footprints(std::vector<source::BuildingRecord>& records);
  Result<std::optional<source::Area>> wanted_area() const;

  postgres::Connection& connection_;
  const Schema& schema_;
  const Instance& instance_;
  const std::string name_;
  const std::uint32_t chunk_;
  const BuildingQuery& query_;
  const ReadLimits& limits_;
  source::DocumentFacts facts_{};
  std::stop_token stop_{};
  std::vector<Candidate> found_{};  ///< by a query for all or for a box; kept from files()
};

/// What a request wants in the coordinates of the database, with its axes in this order.
Result<source::Area> area_in_database(const RequestBox& box, const Instance& instance,
                                      AxisOrder order);

}  // namespace citymesh::citydb
