#include "services/catalogue/database.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/catalogue/records.h"

namespace citymesh::catalogue {
namespace {

using namespace source;
using sqlite::Durability;
using sqlite::Query;
using sqlite::Transaction;

constexpr std::int64_t kApplication = 0x434d4341;  // "CMCA"
constexpr std::int64_t kSchema = 1;

// The number of a building is that of its file and its own in the file, so that both orders are
// those of the key.
constexpr int kBuildingBits = 32;

constexpr const char* kTables = R"sql(
CREATE TABLE source (
  name TEXT PRIMARY KEY, time_ns INTEGER NOT NULL, bytes INTEGER NOT NULL, hash TEXT NOT NULL
) WITHOUT ROWID;
CREATE TABLE file (
  id INTEGER PRIMARY KEY, source TEXT NOT NULL REFERENCES source, name TEXT NOT NULL UNIQUE,
  text TEXT NOT NULL, format INTEGER, buildings INTEGER NOT NULL, facts TEXT NOT NULL);
CREATE INDEX file_source ON file(source);
CREATE TABLE building (
  id INTEGER PRIMARY KEY, gml_id TEXT NOT NULL, parts TEXT NOT NULL, srs INTEGER NOT NULL,
  min_x REAL, min_y REAL, min_z REAL, max_x REAL, max_y REAL, max_z REAL,
  begin INTEGER NOT NULL, end INTEGER NOT NULL, envelope INTEGER NOT NULL, nth INTEGER NOT NULL,
  borrowed TEXT NOT NULL, footprint BLOB NOT NULL);
CREATE VIRTUAL TABLE building_box USING rtree(id, min_x, max_x, min_y, max_y);
CREATE TABLE object (gml_id TEXT NOT NULL, building INTEGER NOT NULL,
  PRIMARY KEY (gml_id, building)) WITHOUT ROWID;
CREATE TABLE shared_place (
  file INTEGER NOT NULL, gml_id TEXT NOT NULL, begin INTEGER NOT NULL, end INTEGER NOT NULL,
  envelope INTEGER NOT NULL, PRIMARY KEY (file, gml_id)) WITHOUT ROWID;
)sql";

#define CITYMESH_BUILDING_COLUMNS                                                          \
  "b.id, b.gml_id, b.parts, b.srs, b.min_x, b.min_y, b.min_z, b.max_x, b.max_y, b.max_z, " \
  "b.begin, b.end, b.envelope, b.nth, b.borrowed, b.footprint"

std::int64_t integer(std::uint64_t value) { return static_cast<std::int64_t>(value); }

Result<BuildingRecord> building_of(const Query& row, bool with_footprint) {
  BuildingRecord building;
  building.number = static_cast<std::uint64_t>(row.number(0)) & ((1ull << kBuildingBits) - 1);
  building.gml_id = row.text(1);
  auto parts = read_list(row.text_view(2));
  if (!parts) return parts.error();
  building.part_ids = std::move(*parts);
  building.srs = static_cast<std::uint32_t>(row.number(3));
  if (row.optional_number(4)) {
    building.extent.add(Point3{row.real(4), row.real(5), row.real(6)});
    building.extent.add(Point3{row.real(7), row.real(8), row.real(9)});
  }
  building.bytes = {static_cast<std::uint64_t>(row.number(10)),
                    static_cast<std::uint64_t>(row.number(11))};
  building.envelope = static_cast<std::uint32_t>(row.number(12));
  building.nth_of_piece = static_cast<std::uint32_t>(row.number(13));
  auto borrowed = read_list(row.text_view(14));
  if (!borrowed) return borrowed.error();
  building.borrowed = std::move(*borrowed);
  if (with_footprint) {
    auto footprint = read_footprint(row.text_view(15));
    if (!footprint) return footprint.error();
    building.footprint = std::move(*footprint);
  }
  return building;
}

Result<void> deliver(Query& rows, const RecordQuery& query, const RecordSink& sink) {
  while (rows.step()) {
    auto building = building_of(rows, query.with_footprints);
    if (!building) return building.error();
    // The tree keeps float32: what it finds is tested again.
    if (query.box && !query.box->meets(building->extent)) continue;
    if (auto taken = sink(*building); !taken) return taken;
  }
  return {};
}

}  // namespace

Database::Database(const std::filesystem::path& state)
    : state_(state), connection_(state / "catalogue.sqlite") {}

Result<std::unique_ptr<Database>> Database::open(const std::filesystem::path& state) {
  try {
    std::unique_ptr<Database> database(new Database(state));
    sqlite::Connection& connection = database->connection_;
    connection.run("PRAGMA journal_mode = WAL");
    if (connection.value("PRAGMA user_version") == 0) {
      Transaction transaction(connection, Durability::Relaxed);
      if (connection.value("PRAGMA user_version") == 0) {
        connection.run(kTables);
        connection.run(fmt::format("PRAGMA application_id = {}", kApplication).c_str());
        connection.run(fmt::format("PRAGMA user_version = {}", kSchema).c_str());
      }
      transaction.commit();
    }
    if (connection.value("PRAGMA application_id") != kApplication ||
        connection.value("PRAGMA user_version") != kSchema)
      return fail(ErrorCode::FailedPrecondition,
                  fmt::format("'{}' was made by another version: remove it, it will be made anew",
                              (state / "catalogue.sqlite").string()));
    return database;
  } catch (const sqlite::Failure& failure) {
    return sqlite::as_error(failure, "catalogue '" + state.string() + "'");
  }
}

std::optional<KnownSource> Database::find(const std::string& source) {
  auto row = connection_.query("SELECT time_ns, bytes, hash FROM source WHERE name = ?1");
  row.bind(1, source);
  if (!row.step()) return std::nullopt;
  return KnownSource{{row.number(0), static_cast<std::uint64_t>(row.number(1))}, row.text(2)};
}

std::vector<std::string> Database::sources() {
  std::vector<std::string> names;
  auto rows = connection_.query("SELECT name FROM source ORDER BY name");
  while (rows.step()) names.push_back(rows.text(0));
  return names;
}

void Database::touch(const std::string& source, const FileStamp& stamp) {
  connection_.query("UPDATE source SET time_ns = ?2, bytes = ?3 WHERE name = ?1")
      .bind(1, source)
      .bind(2, stamp.time_ns)
      .bind(3, integer(stamp.bytes))
      .run();
}

void Database::remove_rows(const std::string& source) {
  std::vector<std::int64_t> ids;
  {
    auto rows = connection_.query("SELECT id FROM file WHERE source = ?1");
    rows.bind(1, source);
    while (rows.step()) ids.push_back(rows.number(0));
  }
  for (const std::int64_t id : ids) {
    const std::int64_t first = id << kBuildingBits, last = ((id + 1) << kBuildingBits) - 1;
    for (const char* sql :
         {"DELETE FROM object WHERE building IN (SELECT id FROM building WHERE id BETWEEN ?1 AND "
          "?2)"
          " AND gml_id IN (SELECT gml_id FROM building WHERE id BETWEEN ?1 AND ?2 UNION "
          "SELECT value FROM building, json_each(parts) WHERE building.id BETWEEN ?1 AND ?2 AND "
          "parts <> '')",
          "DELETE FROM building_box WHERE id IN (SELECT id FROM building WHERE id BETWEEN ?1 AND "
          "?2)",
          "DELETE FROM building WHERE id BETWEEN ?1 AND ?2"})
      connection_.query(sql).bind(1, first).bind(2, last).run();
    connection_.query("DELETE FROM shared_place WHERE file = ?1").bind(1, id).run();
  }
  connection_.query("DELETE FROM file WHERE source = ?1").bind(1, source).run();
}

void Database::insert(const std::string& source, const FileScan& file) {
  const std::string text =
      file.text == file.path ? "" : file.text.lexically_relative(state_).string();
  connection_
      .query(
          "INSERT INTO file (source, name, text, format, buildings, facts) "
          "VALUES (?1, ?2, ?3, ?4, ?5, ?6)")
      .bind(1, source)
      .bind(2, file.name)
      .bind(3, text)
      .bind(4, file.format ? std::optional(static_cast<std::int64_t>(*file.format)) : std::nullopt)
      .bind(5, integer(file.buildings))
      .bind(6, facts_text(file))
      .run();
  const std::int64_t id = connection_.value("SELECT last_insert_rowid()");

  for (const BuildingRecord& building : file.records) {
    const std::int64_t key = (id << kBuildingBits) + integer(building.number);
    auto row = connection_.query(
        "INSERT INTO building VALUES (?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13,?14,?15,?16)");
    row.bind(1, key).bind(2, building.gml_id).bind(3, list_text(building.part_ids));
    row.bind(4, std::int64_t{building.srs});
    const Box3& box = building.extent;
    if (!box.is_empty())
      row.bind(5, box.min.x)
          .bind(6, box.min.y)
          .bind(7, box.min.z)
          .bind(8, box.max.x)
          .bind(9, box.max.y)
          .bind(10, box.max.z);
    row.bind(11, integer(building.bytes.begin)).bind(12, integer(building.bytes.end));
    row.bind(13, std::int64_t{building.envelope}).bind(14, std::int64_t{building.nth_of_piece});
    row.bind(15, list_text(building.borrowed)).bind(16, footprint_bytes(building.footprint));
    row.run();
    if (!box.is_empty())
      connection_.query("INSERT INTO building_box VALUES (?1, ?2, ?3, ?4, ?5)")
          .bind(1, key)
          .bind(2, box.min.x)
          .bind(3, box.max.x)
          .bind(4, box.min.y)
          .bind(5, box.max.y)
          .run();
    const auto add_object = [&](const std::string& gml_id) {
      connection_.query("INSERT OR IGNORE INTO object VALUES (?1, ?2)")
          .bind(1, gml_id)
          .bind(2, key)
          .run();
    };
    add_object(building.gml_id);
    for (const std::string& part : building.part_ids) add_object(part);
  }
  for (const auto& [gml_id, place] : file.shared_places)
    connection_.query("INSERT OR IGNORE INTO shared_place VALUES (?1, ?2, ?3, ?4, ?5)")
        .bind(1, id)
        .bind(2, gml_id)
        .bind(3, integer(place.bytes.begin))
        .bind(4, integer(place.bytes.end))
        .bind(5, std::int64_t{place.envelope})
        .run();
}

void Database::replace(const std::string& source, const KnownSource& known,
                       const std::vector<FileScan>& files) {
  Transaction transaction(connection_, Durability::Relaxed);
  remove_rows(source);
  connection_.query("INSERT OR REPLACE INTO source VALUES (?1, ?2, ?3, ?4)")
      .bind(1, source)
      .bind(2, known.stamp.time_ns)
      .bind(3, integer(known.stamp.bytes))
      .bind(4, known.hash)
      .run();
  for (const FileScan& file : files) insert(source, file);
  transaction.commit();
}

void Database::remove(const std::string& source) {
  Transaction transaction(connection_, Durability::Relaxed);
  remove_rows(source);
  connection_.query("DELETE FROM source WHERE name = ?1").bind(1, source).run();
  transaction.commit();
}

Result<std::vector<Stored>> Database::files(const std::filesystem::path& data) {
  std::vector<Stored> files;
  auto rows = connection_.query(
      "SELECT f.id, f.source, f.name, f.text, f.format, f.buildings, f.facts, s.time_ns, s.bytes "
      "FROM file f JOIN source s ON s.name = f.source ORDER BY f.name");
  while (rows.step()) {
    Stored& stored = files.emplace_back();
    stored.id = rows.number(0);
    FileRecord& file = stored.file;
    file.path = data / rows.text(1);
    file.name = rows.text(2);
    file.found_in_folder = true;
    const std::string text = rows.text(3);
    file.text = text.empty() ? file.path : state_ / text;
    if (const auto format = rows.optional_number(4)) file.format = static_cast<Format>(*format);
    file.buildings = static_cast<std::uint64_t>(rows.number(5));
    file.stamp = FileStamp{rows.number(7), static_cast<std::uint64_t>(rows.number(8))};
    if (auto read = read_facts(rows.text_view(6), file); !read) return read.error();
  }
  for (Stored& stored : files) {
    auto places =
        connection_.query("SELECT gml_id, begin, end, envelope FROM shared_place WHERE file = ?1");
    places.bind(1, stored.id);
    while (places.step())
      stored.file.shared_places.emplace(places.text(0),
                                        SharedPlace{{static_cast<std::uint64_t>(places.number(1)),
                                                     static_cast<std::uint64_t>(places.number(2))},
                                                    static_cast<std::uint32_t>(places.number(3))});
  }
  return files;
}

Result<void> Database::buildings(std::int64_t file, const RecordQuery& query,
                                 const RecordSink& sink) {
  const std::int64_t first = file << kBuildingBits, last = ((file + 1) << kBuildingBits) - 1;
  if (query.ids) {
    std::vector<std::int64_t> keys;
    for (const std::string& id : *query.ids) {
      auto rows = connection_.query(
          "SELECT building FROM object WHERE gml_id = ?1 AND building BETWEEN ?2 AND ?3");
      rows.bind(1, id).bind(2, first).bind(3, last);
      while (rows.step()) keys.push_back(rows.number(0));
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    for (const std::int64_t key : keys) {
      auto row =
          connection_.query("SELECT " CITYMESH_BUILDING_COLUMNS " FROM building b WHERE b.id = ?1");
      row.bind(1, key);
      if (auto done = deliver(row, query, sink); !done) return done;
    }
    return {};
  }
  if (query.box) {
    auto rows = connection_.query(
        "SELECT " CITYMESH_BUILDING_COLUMNS
        " FROM building_box x CROSS JOIN building b ON b.id = x.id WHERE x.min_x <= ?1 AND x.max_x "
        ">= ?2 "
        "AND x.min_y <= ?3 AND x.max_y >= ?4 AND x.id BETWEEN ?5 AND ?6 ORDER BY x.id");
    rows.bind(1, query.box->max.x).bind(2, query.box->min.x);
    rows.bind(3, query.box->max.y).bind(4, query.box->min.y);
    rows.bind(5, first).bind(6, last);
    return deliver(rows, query, sink);
  }
  auto rows = connection_.query("SELECT " CITYMESH_BUILDING_COLUMNS
                                " FROM building b WHERE b.id BETWEEN ?1 AND ?2 ORDER BY b.id");
  rows.bind(1, first).bind(2, last);
  return deliver(rows, query, sink);
}

std::int64_t Database::building_count() {
  return connection_.value("SELECT coalesce(sum(buildings), 0) FROM file");
}

}  // namespace citymesh::catalogue
