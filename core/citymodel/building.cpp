#include "core/citymodel/building.h"

#include <array>
#include <charconv>

#include "core/base/text.h"

namespace citymesh {
namespace {

constexpr std::array<std::pair<SurfaceType, std::string_view>, 12> kSurfaceNames{{
    {SurfaceType::Unknown, "Unknown"},
    {SurfaceType::GroundSurface, "GroundSurface"},
    {SurfaceType::WallSurface, "WallSurface"},
    {SurfaceType::RoofSurface, "RoofSurface"},
    {SurfaceType::ClosureSurface, "ClosureSurface"},
    {SurfaceType::OuterCeilingSurface, "OuterCeilingSurface"},
    {SurfaceType::OuterFloorSurface, "OuterFloorSurface"},
    {SurfaceType::Window, "Window"},
    {SurfaceType::Door, "Door"},
    {SurfaceType::InteriorWallSurface, "InteriorWallSurface"},
    {SurfaceType::CeilingSurface, "CeilingSurface"},
    {SurfaceType::FloorSurface, "FloorSurface"},
}};

}  // namespace

std::string_view to_string(SurfaceType type) {
  return kSurfaceNames[static_cast<std::size_t>(type)].second;
}

std::optional<SurfaceType> surface_type_from(std::string_view name) {
  for (const auto& [type, type_name] : kSurfaceNames)
    if (type_name == name) return type;
  return std::nullopt;
}

std::string_view to_string(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::Building:
      return "Building";
    case ObjectKind::BuildingPart:
      return "BuildingPart";
    case ObjectKind::BuildingInstallation:
      return "BuildingInstallation";
  }
  return "";
}

std::string to_string(Lod lod) {
  std::string text = std::to_string(lod.major);
  if (lod.minor >= 0) text += "." + std::to_string(lod.minor);
  return text;
}

std::optional<Lod> lod_from(std::string_view text) {
  const auto dot = text.find('.');
  const auto major = number_from<std::int8_t>(text.substr(0, dot));
  if (!major || *major < 0) return std::nullopt;
  if (dot == std::string_view::npos) return Lod{*major};
  const auto minor = number_from<std::int8_t>(text.substr(dot + 1));
  if (!minor || *minor < 0) return std::nullopt;
  return Lod{*major, *minor};
}

std::optional<double> number_attribute(const Attributes& attributes, std::string_view name) {
  for (const auto& [key, value] : attributes) {
    if (key != name) continue;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
    if (const auto* text = std::get_if<std::string>(&value))
      return number_from<double>(trimmed(*text));
    return std::nullopt;
  }
  return std::nullopt;
}

Box3 extent(const Building& building) {
  Box3 box;
  for (const Geometry& geometry : building.geometries)
    for (const Point3& point : geometry.points) box.add(point);
  for (const Building& part : building.parts) box.add(extent(part));
  return box;
}

}  // namespace citymesh
