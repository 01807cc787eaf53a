#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/citymodel/issue.h"
#include "core/geometry/point.h"

namespace citymesh {

/// CityGML's names; `Unknown` where the source does not tell.
enum class SurfaceType : std::uint8_t {
  Unknown,
  GroundSurface,
  WallSurface,
  RoofSurface,
  ClosureSurface,
  OuterCeilingSurface,
  OuterFloorSurface,
  Window,
  Door,
  InteriorWallSurface,
  CeilingSurface,
  FloorSurface,
};

std::string_view to_string(SurfaceType type);
std::optional<SurfaceType> surface_type_from(std::string_view name);

/// A boundary surface or an opening of a building.
struct Surface {
  SurfaceType type = SurfaceType::Unknown;
  std::string gml_id{};
  std::int32_t parent = -1;  ///< for openings: index of the wall or roof in Building::surfaces
  std::string made_by{};     ///< rung of an earlier healing that made it; empty: of the source
};

/// "2", "2.2": minor is -1 where the source gives none.
struct Lod {
  std::int8_t major = 0;
  std::int8_t minor = -1;
  friend auto operator<=>(const Lod&, const Lod&) = default;
};

std::string to_string(Lod lod);
std::optional<Lod> lod_from(std::string_view text);

/// Corner indices into Geometry::points, in the order and with the repetitions of the source.
using Ring = std::vector<std::uint32_t>;

struct Polygon {
  std::vector<Ring> rings{};  ///< the first is the exterior
  std::int32_t surface = -1;  ///< index into Building::surfaces, -1: none stated
  std::string gml_id{};
};

/// Polygon indices into Geometry::polygons; `interiors` are cavities.
struct Solid {
  std::vector<std::uint32_t> exterior{};
  std::vector<std::vector<std::uint32_t>> interiors{};
};

enum class GeometryType : std::uint8_t {
  MultiSurface,
  CompositeSurface,
  Solid,
  MultiSolid,
  CompositeSolid
};

struct Geometry {
  GeometryType type = GeometryType::MultiSurface;
  Lod lod{};
  bool assembled = false;  ///< collected by the reader from boundary surfaces; the source states no
                           ///< such geometry
  bool footprint = false;  ///< LoD0 footprint or roof edge: an area, not a shell
  bool closed_rings = false;  ///< the encoding repeats the first corner of a ring at its end
  std::vector<Point3> points{};
  std::vector<Polygon> polygons{};
  std::vector<Solid> solids{};  ///< empty for surfaces
};

using AttributeValue = std::variant<bool, std::int64_t, double, std::string>;
using Attributes = std::vector<std::pair<std::string, AttributeValue>>;  ///< in source order

/// A postal address, by the parts that xAL and 3DCityDB tell apart; empty where the source has
/// none.
struct Address {
  std::string street{};
  std::string house_number{};
  std::string po_box{};
  std::string zip_code{};
  std::string city{};
  std::string state{};
  std::string country{};
  friend bool operator==(const Address&, const Address&) = default;
};

enum class ObjectKind : std::uint8_t { Building, BuildingPart, BuildingInstallation };

std::string_view to_string(ObjectKind kind);

/// A Building, BuildingPart or BuildingInstallation. Coordinates are in the working CRS, axes east,
/// north, up, in metres relative to the origin that the source was asked for; rings are as they
/// came.
struct Building {
  ObjectKind kind = ObjectKind::Building;
  std::string gml_id{};
  std::string parent{};  ///< gml_id of what a part or an installation belongs to, else empty
  std::vector<Surface> surfaces{};
  std::vector<Geometry> geometries{};
  Attributes attributes{};
  std::vector<Address> addresses{};
  std::vector<Building> parts{};
  std::vector<Building> installations{};  ///< outer ones, whether they will be used or not
  std::vector<Issue> source_issues{};  ///< what the reader found: dangling xlinks, unreadable rings
  std::map<std::string, std::uint32_t> skipped_ade_elements{};  ///< of extensions, by name
};

/// Numeric value of an attribute (also of text such as "12.5"), if it has one.
std::optional<double> number_attribute(const Attributes& attributes, std::string_view name);

/// Extent of all geometries of the building and its parts, without installations.
Box3 extent(const Building& building);

}  // namespace citymesh
