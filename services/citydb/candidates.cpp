#include "services/citydb/candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "core/source/scan.h"

namespace citymesh::citydb {
namespace {

using source::Area;
using source::BuildingRecord;
using source::FlatBox;
using source::Point2;

constexpr std::uint32_t kSrs = 1;  // the first name of DocumentFacts stands for none

// A box is looked for a little larger than it is; what it chooses is decided exactly afterwards.
constexpr double kMargin = 0.02, kMarginUnits = 1e-6;

FlatBox enlarged(const Box3& box) {
  const double margin =
      kMargin * std::max(box.max.x - box.min.x, box.max.y - box.min.y) + kMarginUnits;
  return {{box.min.x - margin, box.min.y - margin}, {box.max.x + margin, box.max.y + margin}};
}

std::array<Point2, 4> corners(const Box3& box) {
  return {{{box.min.x, box.min.y},
           {box.max.x, box.min.y},
           {box.max.x, box.max.y},
           {box.min.x, box.max.y}}};
}

source::Footprints footprint_of(const Box3& envelope) {
  source::Footprints footprint;
  for (const auto& corner : corners(envelope)) footprint.points.push_back(corner);
  footprint.points.push_back(footprint.points.front());
  footprint.rings.push_back({0, static_cast<std::uint32_t>(footprint.points.size()), true});
  return footprint;
}

std::vector<Candidate> read_candidates(const postgres::Rows& rows) {
  std::vector<Candidate> all;
  all.reserve(static_cast<std::size_t>(rows.size()));
  for (int row = 0; row < rows.size(); ++row) {
    auto& candidate = all.emplace_back();
    candidate.id = rows.integer(row, 0);
    candidate.gml_id = rows.text(row, 1);
    if (rows.null(row, 2)) continue;
    candidate.envelope.add(Point3{rows.number(row, 2), rows.number(row, 3), rows.number(row, 4)});
    candidate.envelope.add(Point3{rows.number(row, 5), rows.number(row, 6), rows.number(row, 7)});
  }
  return all;
}

}  // namespace

DatabaseCatalogue::DatabaseCatalogue(postgres::Connection& connection, const Schema& schema,
                                     const Instance& instance, std::string name,
                                     std::uint32_t chunk, const BuildingQuery& query,
                                     const ReadLimits& limits)
    : connection_(connection),
      schema_(schema),
      instance_(instance),
      name_(std::move(name)),
      chunk_(std::max<std::uint32_t>(chunk, 1)),
      query_(query),
      limits_(limits) {
  facts_.format = "3DCityDB " + instance.version;
  facts_.srs_names = {"", instance.srs_name};
}

Result<Area> area_in_database(const RequestBox& box, const Instance& instance, AxisOrder order) {
  const auto crs = parse_crs(instance.srs_name);
  if (!crs) return crs.error();
  std::optional<Transformer> transformer;
  if (box.crs.known() && crs->known()) {
    auto found = Transformer::create(box.crs, *crs);
    if (!found) return found.error();
    transformer = *std::move(found);
  }
  auto rings = source::rings_of(box, transformer ? &*transformer : nullptr);
  if (!rings) return rings.error();
  if (order == AxisOrder::NorthEast)
    for (auto& ring : *rings)
      for (auto& point : ring) std::swap(point.x, point.y);
  return Area(*std::move(rings));
}

/// What the request wants; none: everything.
Result<std::optional<Area>> DatabaseCatalogue::wanted_area() const {
  if (!query_.bbox) return std::optional<Area>{};
  auto wanted = area_in_database(*query_.bbox, instance_, query_.axis_order);
  if (!wanted) return wanted.error();
  return std::optional(*std::move(wanted));
}

Result<std::vector<std::shared_ptr<const source::FileRecord>>> DatabaseCatalogue::files(
    bool, const RunContext& context) {
  stop_ = context.stop;
  auto record = std::make_shared<source::FileRecord>();
  record->name = name_;
  record->facts = facts_;
  record->srs.resize(facts_.srs_names.size());
  auto& srs = record->srs[kSrs];

  const auto area = wanted_area();
  if (!area) return area.error();
  if (*area) {
    // Where the box is, buildings are: what is known of the whole database plays no part, so that
    // the same box has the same frame tomorrow.
    srs.all.add(Point3{(*area)->min().x, (*area)->min().y, 0});
    srs.all.add(Point3{(*area)->max().x, (*area)->max().y, 0});
    const auto wide = enlarged(srs.all);
    srs.all.add(Point3{wide.min.x, wide.min.y, 0});
    srs.all.add(Point3{wide.max.x, wide.max.y, 0});
    if (query_.object_ids.empty()) {
      const auto rows = connection_.run(schema_.candidates(instance_, wide), stop_);
      if (!rows) return rows.error();
      found_ = read_candidates(*rows);
      record->buildings = found_.size();
    }
    srs.buildings = 1;
  } else {
    const auto rows = connection_.run(schema_.extent(instance_), stop_);
    if (!rows) return rows.error();
    record->buildings = static_cast<std::uint64_t>(rows->integer(0, 0));
    if (!rows->null(0, 1)) {
      srs.all.add(Point3{rows->number(0, 1), rows->number(0, 2), rows->number(0, 3)});
      srs.all.add(Point3{rows->number(0, 4), rows->number(0, 5), rows->number(0, 6)});
    }
    srs.buildings = srs.all.is_empty() ? 0 : record->buildings;
  }
  srs.near_m = srs.near_deg = srs.all;
  return std::vector<std::shared_ptr<const source::FileRecord>>{std::move(record)};
}

Result<std::vector<Candidate>> DatabaseCatalogue::candidates(const source::RecordQuery& query) {
  if (query.ids == nullptr && query_.bbox) {
    std::vector<Candidate> meeting;
    for (auto& candidate : found_)
      if (!query.box || query.box->meets(candidate.envelope)) meeting.push_back(candidate);
    return meeting;
  }
  std::vector<std::string> ids;
  if (query.ids != nullptr) ids.assign(query.ids->begin(), query.ids->end());
  std::ranges::sort(ids);
  const auto rows =
      connection_.run(query.ids != nullptr ? schema_.candidates_by_id(instance_, ids)
                                           : schema_.candidates(instance_, std::nullopt),
                      stop_);
  if (!rows) return rows.error();
  return read_candidates(*rows);
}

Result<void> DatabaseCatalogue::buildings(const source::FileRecord&,
                                          const source::RecordQuery& query,
                                          const source::RecordSink& sink) {
  auto chosen = candidates(query);
  if (!chosen) return chosen.error();
  for (std::size_t first = 0; first < chosen->size(); first += chunk_) {
    std::vector<BuildingRecord> records;
    for (std::size_t c = first; c < std::min(first + chunk_, chosen->size()); ++c) {
      auto& candidate = (*chosen)[c];
      auto& record = records.emplace_back();
      record.number = static_cast<std::uint64_t>(candidate.id);
      record.gml_id = std::move(candidate.gml_id);
      record.extent = candidate.envelope;
      record.srs = kSrs;
    }
    if (auto added = add_members(records); !added) return added;
    if (query.with_footprints)
      if (auto added = add_footprints(records); !added) return added;
    for (const auto& record : records)
      if (auto taken = sink(record); !taken) return taken;
  }
  return {};
}

Result<void> DatabaseCatalogue::add_members(std::vector<BuildingRecord>& records) {
  std::vector<std::int64_t> ids;
  std::unordered_map<std::int64_t, BuildingRecord*> by_id;
  for (auto& record : records) {
    ids.push_back(static_cast<std::int64_t>(record.number));
    by_id.emplace(ids.back(), &record);
  }
  const auto rows = connection_.run(schema_.members(instance_, ids), stop_);
  if (!rows) return rows.error();
  for (int row = 0; row < rows->size(); ++row)
    if (const auto owner = by_id.find(rows->integer(row, 0)); owner != by_id.end())
      owner->second->part_ids.emplace_back(rows->text(row, 1));
  return {};
}

Result<void> DatabaseCatalogue::add_footprints(std::vector<BuildingRecord>& records) {
  const auto area = wanted_area();
  if (!area) return area.error();
  std::vector<std::int64_t> crossing;
  std::unordered_map<std::int64_t, BuildingRecord*> by_id;
  for (auto& record : records) {
    if (record.extent.is_empty()) continue;
    record.footprint = footprint_of(record.extent);
    const auto at = corners(record.extent);
    const bool inside = (*area)->contains_sides(at);
    if (inside || !(*area)->box_touches(at[0], at[2])) continue;
    crossing.push_back(static_cast<std::int64_t>(record.number));
    by_id.emplace(crossing.back(), &record);
  }
  if (crossing.empty()) return {};
  const auto tables = schema_.fetch(connection_, instance_, std::move(crossing), stop_);
  if (!tables) return tables.error();
  FeatureBuilder builder(facts_, kSrs, limits_);
  std::size_t next = 0;
  return schema_.build(*tables, instance_, builder, [&](source::Feature& feature) -> Result<void> {
    by_id.at(tables->ids[next++])->footprint = source::footprints_of(feature);
    return {};
  });
}

}  // namespace citymesh::citydb
