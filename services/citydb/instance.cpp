#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "services/citydb/schema.h"

namespace citymesh::citydb {
namespace {

using postgres::Statement;

/// Version 4 has the class names of CityGML with the module in them: OuterBuildingFloorSurface.
ObjectClass class_of(std::string_view name) {
  ObjectClass found{.name = std::string(name)};
  if (name == "Building") found.kind = ObjectKind::Building;
  if (name == "BuildingPart") found.kind = ObjectKind::BuildingPart;
  if (name == "BuildingInstallation") found.kind = ObjectKind::BuildingInstallation;
  if (found.kind) return found;
  std::string plain(name);
  constexpr std::string_view kModule = "Building";
  if (const auto at = plain.find(kModule); at != std::string::npos) plain.erase(at, kModule.size());
  if (plain == "WindowSurface") plain = "Window";  // as CityGML 3.0 calls them
  if (plain == "DoorSurface") plain = "Door";
  found.surface = surface_type_from(plain);
  return found;
}

Error no_citydb(const postgres::Connection& connection, const std::string& schema,
                std::string_view what) {
  return fail(ErrorCode::FailedPrecondition,
              fmt::format("schema '{}' of the database {}, expected a 3DCityDB of version 4 or 5; "
                          "{} names another one",
                          schema, what, connection.purpose().schema_flag));
}

}  // namespace

std::vector<std::int64_t> Instance::ids_of(ObjectKind kind) const {
  std::vector<std::int64_t> ids;
  for (const auto& [id, object] : classes)
    if (object.kind == kind) ids.push_back(id);
  return ids;
}

Result<Instance> look_at(postgres::Connection& connection, const std::string& schema,
                         const std::stop_token& stop) {
  const auto probe = connection.run(
      Statement{"SELECT to_regclass(quote_ident($1) || '.surface_geometry') IS NOT NULL,"
                " to_regclass(quote_ident($1) || '.geometry_data') IS NOT NULL,"
                " to_regproc('citydb_pkg.citydb_version') IS NOT NULL,"
                " to_regtype('geometry') IS NOT NULL",
                {schema}},
      stop);
  if (!probe) return probe.error();
  const bool v4 = probe->integer(0, 0) != 0, v5 = probe->integer(0, 1) != 0;
  if (probe->integer(0, 3) == 0) return no_citydb(connection, schema, "has no PostGIS in reach");
  if (!v4 && !v5)
    return no_citydb(connection, schema, "has neither table surface_geometry nor geometry_data");

  Instance instance;
  instance.major = v5 ? 5 : 4;
  instance.version = std::to_string(instance.major);
  if (probe->integer(0, 2) != 0) {
    const auto version =
        connection.run(Statement{"SELECT version::text FROM citydb_pkg.citydb_version()"}, stop);
    if (!version) return version.error();
    // One package serves schemas of its own version only.
    if (version->size() == 1 && version->text(0, 0).starts_with(instance.version))
      instance.version = version->text(0, 0);
  }

  const auto srs =
      connection.run(Statement{v5 ? "SELECT srid, srs_name FROM database_srs LIMIT 1"
                                  : "SELECT srid, gml_srs_name FROM database_srs LIMIT 1"},
                     stop);
  if (!srs) return srs.error();
  if (srs->size() != 1) return no_citydb(connection, schema, "states no CRS in database_srs");
  instance.srid = static_cast<int>(srs->integer(0, 0));
  instance.srs_name = srs->text(0, 1);
  if (const auto named = parse_crs(instance.srs_name); !named || !named->known())
    instance.srs_name = fmt::format("EPSG:{}", instance.srid);
  if (const auto facts = describe_crs({fmt::format("EPSG:{}", instance.srid)});
      !facts && !describe_crs(*parse_crs(instance.srs_name)))
    return no_citydb(connection, schema,
                     fmt::format("has SRID {} and CRS '{}' in database_srs, which nobody "
                                 "knows: correct that table",
                                 instance.srid, srs->text(0, 1)));

  const auto classes = connection.run(Statement{"SELECT id, classname FROM objectclass"}, stop);
  if (!classes) return classes.error();
  for (int row = 0; row < classes->size(); ++row)
    instance.classes.emplace(classes->integer(row, 0), class_of(classes->text(row, 1)));
  if (instance.ids_of(ObjectKind::Building).empty())
    return no_citydb(connection, schema, "has no class Building in objectclass");
  return instance;
}

Statement candidates_of(const char* all, const char* in_box, const Instance& instance,
                        const std::optional<source::FlatBox>& box) {
  auto classes = postgres::array_of(instance.ids_of(ObjectKind::Building));
  if (!box) return {all, {std::move(classes)}};
  return {in_box,
          {std::move(classes), fmt::format("{}", box->min.x), fmt::format("{}", box->min.y),
           fmt::format("{}", box->max.x), fmt::format("{}", box->max.y),
           std::to_string(instance.srid)}};
}

std::unique_ptr<const Schema> schema_of(const Instance& instance) {
  return instance.major == 5 ? schema_v5() : schema_v4();
}

}  // namespace citymesh::citydb
