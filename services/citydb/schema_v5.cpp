#include <fmt/format.h>

#include <utility>

#include "services/citydb/chunk_v5.h"
#include "services/citydb/schema.h"

/// 3DCityDB 5: features of all levels are rows of one table, all that they have and contain are
/// rows of another.
namespace citymesh::citydb {
namespace {

using postgres::Statement;

constexpr const char* kInBox =
    "SELECT f.id, f.objectid, ST_XMin(f.envelope), ST_YMin(f.envelope), ST_ZMin(f.envelope),"
    " ST_XMax(f.envelope), ST_YMax(f.envelope), ST_ZMax(f.envelope)"
    " FROM feature f WHERE f.objectclass_id = ANY($1::int[]) AND f.termination_date IS NULL"
    " AND f.envelope && ST_MakeEnvelope($2::float8, $3::float8, $4::float8, $5::float8, $6::int)"
    " ORDER BY f.id";
constexpr const char* kAll =
    "SELECT f.id, f.objectid, ST_XMin(f.envelope), ST_YMin(f.envelope), ST_ZMin(f.envelope),"
    " ST_XMax(f.envelope), ST_YMax(f.envelope), ST_ZMax(f.envelope)"
    " FROM feature f WHERE f.objectclass_id = ANY($1::int[]) AND f.termination_date IS NULL"
    " ORDER BY f.id";
constexpr const char* kExtent =
    "SELECT count(*), min(ST_XMin(f.envelope)), min(ST_YMin(f.envelope)), min(ST_ZMin(f.envelope)),"
    " max(ST_XMax(f.envelope)), max(ST_YMax(f.envelope)), max(ST_ZMax(f.envelope))"
    " FROM feature f WHERE f.objectclass_id = ANY($1::int[]) AND f.termination_date IS NULL";
// A GiST index has to be read from end to end for what has no box: the statistics decide whether.
constexpr const char* kWithoutEnvelope =
    "SELECT count(*) FROM feature f WHERE f.objectclass_id = ANY($1::int[])"
    " AND f.termination_date IS NULL AND f.envelope IS NULL"
    " AND coalesce((SELECT max(s.null_frac) > 0 FROM pg_stats s WHERE s.attname = 'envelope'"
    " AND s.tablename = 'feature' AND s.schemaname = current_schema()), true)";
// OFFSET 0: see chunk_v5.cpp.
constexpr const char* kById =
    "WITH RECURSIVE up(id) AS (SELECT f.id FROM feature f WHERE f.objectid = ANY($2::text[])"
    " AND f.objectclass_id = ANY($3::int[]) AND f.termination_date IS NULL"
    " UNION SELECT f.id FROM up CROSS JOIN LATERAL (SELECT p.feature_id FROM property p"
    " WHERE p.val_feature_id = up.id AND p.val_relation_type = 1"
    " AND p.name IN ('buildingPart', 'buildingInstallation') OFFSET 0) p"
    " CROSS JOIN LATERAL (SELECT f.id FROM feature f WHERE f.id = p.feature_id"
    " AND f.termination_date IS NULL OFFSET 0) f)"
    " SELECT f.id, f.objectid, ST_XMin(f.envelope), ST_YMin(f.envelope), ST_ZMin(f.envelope),"
    " ST_XMax(f.envelope), ST_YMax(f.envelope), ST_ZMax(f.envelope)"
    " FROM up CROSS JOIN LATERAL (SELECT * FROM feature b WHERE b.id = up.id OFFSET 0) f"
    " WHERE f.objectclass_id = ANY($1::int[]) ORDER BY f.id";
// Installations inside are none of ours; they are told from the others by an attribute only.
constexpr const char* kMembers =
    "WITH RECURSIVE h(root_id, id, gml_id) AS (SELECT x, x, NULL::text FROM unnest($1::bigint[]) x"
    " UNION SELECT h.root_id, f.id, f.objectid FROM h"
    " CROSS JOIN LATERAL (SELECT p.val_feature_id FROM property p WHERE p.feature_id = h.id"
    " AND p.val_relation_type = 1 AND p.name IN ('buildingPart', 'buildingInstallation')"
    " OFFSET 0) p CROSS JOIN LATERAL (SELECT f.id, f.objectid FROM feature f"
    " WHERE f.id = p.val_feature_id AND f.termination_date IS NULL OFFSET 0) f)"
    " SELECT h.root_id, h.gml_id, h.id FROM h WHERE h.id <> h.root_id"
    " AND (SELECT count(*) FROM (SELECT a.name, a.val_string FROM property a"
    " WHERE a.feature_id = h.id OFFSET 0) q WHERE q.name = 'relationToConstruction'"
    " AND q.val_string = 'inside') = 0 ORDER BY 1, 3";

class SchemaV5 final : public Schema {
 public:
  Statement candidates(const Instance& instance,
                       const std::optional<source::FlatBox>& box) const override {
    return candidates_of(kAll, kInBox, instance, box);
  }

  Statement extent(const Instance& instance) const override {
    return {kExtent, {postgres::array_of(instance.ids_of(ObjectKind::Building))}};
  }

  Statement without_envelope(const Instance& instance) const override {
    return {kWithoutEnvelope, {postgres::array_of(instance.ids_of(ObjectKind::Building))}};
  }

  std::string sql_for_envelopes(const std::string& schema) const override {
    return fmt::format(
        "SELECT citydb_pkg.get_feature_envelope(id, '{0}', 0, 1) FROM {0}.feature"
        " WHERE envelope IS NULL",
        schema);
  }

  Statement candidates_by_id(const Instance& instance,
                             std::span<const std::string> gml_ids) const override {
    std::vector<std::int64_t> objects;
    for (const auto& [id, known] : instance.classes)
      if (known.kind) objects.push_back(id);
    return {kById,
            {postgres::array_of(instance.ids_of(ObjectKind::Building)), postgres::array_of(gml_ids),
             postgres::array_of(objects)}};
  }

  Statement members(const Instance&, std::span<const std::int64_t> ids) const override {
    return {kMembers, {postgres::array_of(ids)}};
  }

  Result<Tables> fetch(postgres::Connection& connection, const Instance&,
                       std::vector<std::int64_t> ids, const std::stop_token& stop) const override {
    return fetch_v5(connection, std::move(ids), stop);
  }

  Result<void> build(const Tables& tables, const Instance& instance, FeatureBuilder& builder,
                     const source::FeatureSink& sink) const override {
    return build_v5(tables, instance, builder, sink);
  }
};

}  // namespace

std::unique_ptr<const Schema> schema_v5() { return std::make_unique<SchemaV5>(); }

}  // namespace citymesh::citydb
