#include "core/source/citygml_names.h"

#include <algorithm>
#include <array>
#include <optional>

namespace citymesh::source {
namespace {

struct TagName {
  std::string_view name;
  Tag tag;
};

constexpr std::array kCoreNames{
    TagName{"CityModel", Tag::CityModel},
    TagName{"cityObjectMember", Tag::MemberProperty},
    TagName{"boundary", Tag::BoundaryProperty},
    TagName{"genericAttribute", Tag::GenericProperty},
    TagName{"ClosureSurface", Tag::BoundarySurface},
    TagName{"externalReference", Tag::Skipped},
    TagName{"generalizesTo", Tag::Skipped},
    TagName{"relatedTo", Tag::Skipped},
    TagName{"appearance", Tag::Skipped},
    TagName{"appearanceMember", Tag::Skipped},
    TagName{"address", Tag::AddressProperty},
    TagName{"Address", Tag::Address},
    TagName{"xalAddress", Tag::XalProperty},
    TagName{"ImplicitGeometry", Tag::Implicit},
    TagName{"transformationMatrix", Tag::Matrix},
    TagName{"relativeGMLGeometry", Tag::RelativeGeometry},
    TagName{"relativeGeometry", Tag::RelativeGeometry},
    TagName{"referencePoint", Tag::ReferencePoint},
    TagName{"featureMember", Tag::MemberProperty},
};

constexpr std::array kBuildingNames{
    TagName{"Building", Tag::Building},
    TagName{"BuildingPart", Tag::BuildingPart},
    TagName{"boundedBy", Tag::BoundaryProperty},
    TagName{"consistsOfBuildingPart", Tag::PartProperty},
    TagName{"buildingPart", Tag::PartProperty},
    TagName{"outerBuildingInstallation", Tag::InstallationProperty},
    TagName{"buildingInstallation", Tag::InstallationProperty},
    TagName{"BuildingInstallation", Tag::Installation},
    TagName{"interiorBuildingInstallation", Tag::Interior},
    TagName{"interiorRoom", Tag::Interior},
    TagName{"buildingRoom", Tag::Interior},
    TagName{"buildingFurniture", Tag::Interior},
    TagName{"buildingSubdivision", Tag::Interior},
    TagName{"buildingConstructiveElement", Tag::Interior},
    TagName{"opening", Tag::OpeningProperty},
    TagName{"address", Tag::AddressProperty},
};

constexpr std::array kConstructionNames{
    TagName{"fillingSurface", Tag::OpeningProperty},
    TagName{"filling", Tag::FillingProperty},
    TagName{"height", Tag::HeightProperty},
    TagName{"Height", Tag::Height},
    TagName{"value", Tag::Value},
};

constexpr std::array kGenericNames{
    TagName{"stringAttribute", Tag::GenericText},
    TagName{"dateAttribute", Tag::GenericText},
    TagName{"uriAttribute", Tag::GenericText},
    TagName{"intAttribute", Tag::GenericWhole},
    TagName{"doubleAttribute", Tag::GenericNumber},
    TagName{"measureAttribute", Tag::GenericNumber},
    TagName{"genericAttributeSet", Tag::GenericSet},
    TagName{"StringAttribute", Tag::GenericText},
    TagName{"CodeAttribute", Tag::GenericText},
    TagName{"DateAttribute", Tag::GenericText},
    TagName{"UriAttribute", Tag::GenericText},
    TagName{"IntAttribute", Tag::GenericWhole},
    TagName{"DoubleAttribute", Tag::GenericNumber},
    TagName{"MeasureAttribute", Tag::GenericNumber},
    TagName{"GenericAttributeSet", Tag::GenericSet},
    TagName{"genericAttribute", Tag::GenericProperty},
    TagName{"name", Tag::Name},
    TagName{"value", Tag::Value},
};

constexpr std::array kGmlNames{
    TagName{"posList", Tag::Coordinates},
    TagName{"pos", Tag::Position},
    TagName{"coordinates", Tag::Tuples},
    TagName{"Polygon", Tag::Polygon},
    TagName{"exterior", Tag::Exterior},
    TagName{"interior", Tag::InteriorBoundary},
    TagName{"LinearRing", Tag::Ring},
    TagName{"surfaceMember", Tag::GeometryMember},
    TagName{"MultiSurface", Tag::MultiSurface},
    TagName{"CompositeSurface", Tag::CompositeSurface},
    TagName{"Solid", Tag::Solid},
    TagName{"boundedBy", Tag::EnvelopeProperty},
    TagName{"Envelope", Tag::Envelope},
    TagName{"lowerCorner", Tag::LowerCorner},
    TagName{"upperCorner", Tag::UpperCorner},
    TagName{"OrientableSurface", Tag::OrientableSurface},
    TagName{"baseSurface", Tag::GeometryMember},
    TagName{"surfaceMembers", Tag::GeometryMember},
    TagName{"solidMember", Tag::GeometryMember},
    TagName{"solidMembers", Tag::GeometryMember},
    TagName{"geometryMember", Tag::GeometryMember},
    TagName{"geometryMembers", Tag::GeometryMember},
    TagName{"element", Tag::GeometryMember},
    TagName{"patches", Tag::GeometryMember},
    TagName{"polygonPatches", Tag::GeometryMember},
    TagName{"trianglePatches", Tag::GeometryMember},
    TagName{"PolygonPatch", Tag::Polygon},
    TagName{"Triangle", Tag::Polygon},
    TagName{"Rectangle", Tag::Polygon},
    TagName{"outerBoundaryIs", Tag::Exterior},
    TagName{"innerBoundaryIs", Tag::InteriorBoundary},
    TagName{"Ring", Tag::Ring},
    TagName{"CompositeSolid", Tag::CompositeSolid},
    TagName{"MultiSolid", Tag::MultiSolid},
    TagName{"Shell", Tag::CompositeSurface},
    TagName{"Surface", Tag::CompositeSurface},
    TagName{"PolyhedralSurface", Tag::CompositeSurface},
    TagName{"TriangulatedSurface", Tag::CompositeSurface},
    TagName{"Tin", Tag::CompositeSurface},
    TagName{"MultiGeometry", Tag::MultiSurface},
    TagName{"GeometricComplex", Tag::MultiSurface},
    TagName{"FeatureCollection", Tag::FeatureCollection},
    TagName{"featureMember", Tag::MemberProperty},
    TagName{"featureMembers", Tag::MemberProperty},
    TagName{"metaDataProperty", Tag::Skipped},
    TagName{"location", Tag::Skipped},
};

constexpr std::array kWfsNames{
    TagName{"FeatureCollection", Tag::FeatureCollection},
    TagName{"member", Tag::MemberProperty},
    TagName{"boundedBy", Tag::EnvelopeProperty},
};

template <std::size_t N>
Tag tag_of(const std::array<TagName, N>& names, std::string_view name) {
  for (const auto& entry : names)
    if (entry.name == name) return entry.tag;
  return Tag::Other;
}

// lod2MultiSurface and the like; openings and boundary surfaces use the same names.
std::optional<ElementName> lod_property(Ns ns, std::string_view name) {
  constexpr std::string_view kPrefix = "lod";
  if (name.size() < 5 || name.substr(0, 3) != kPrefix || name[3] < '0' || name[3] > '4')
    return std::nullopt;
  ElementName element{.ns = ns, .tag = Tag::UnusedGeometry};
  element.lod = static_cast<std::int8_t>(name[3] - '0');
  const std::string_view kind = name.substr(4);
  if (kind == "Solid" || kind == "MultiSurface" || kind == "Surface" || kind == "Geometry" ||
      kind == "FootPrint" || kind == "RoofEdge")
    element.tag = Tag::GeometryProperty;
  if (kind == "ImplicitRepresentation") element.tag = Tag::ImplicitProperty;
  element.footprint = element.lod == 0;
  return element;
}

// WallSurface; 3.0 says WindowSurface for the surface of what 2.0 calls Window.
std::optional<SurfaceType> surface_of(std::string_view name) {
  if (name == "WindowSurface") return SurfaceType::Window;
  if (name == "DoorSurface") return SurfaceType::Door;
  return surface_type_from(name);
}

std::string_view after(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix ? text.substr(prefix.size()) : std::string_view{};
}

}  // namespace

NsMeaning namespace_of(std::string_view uri) {
  if (uri.empty()) return {Ns::None};
  if (const auto rest = after(uri, "http://www.opengis.net/citygml/"); !rest.empty()) {
    const auto slash = rest.rfind('/');
    const auto module =
        slash == std::string_view::npos ? std::string_view{} : rest.substr(0, slash);
    const char major =
        rest[slash == std::string_view::npos ? 0 : std::min(slash + 1, rest.size() - 1)];
    if (module.empty() || module == "profiles/base") return {Ns::Core, major};
    if (module == "building") return {Ns::Building, major};
    if (module == "construction") return {Ns::Construction, major};
    if (module == "generics") return {Ns::Generics, major};
    if (module == "appearance") return {Ns::Appearance, major};
    return {Ns::OtherModule, major};
  }
  if (uri == "http://www.opengis.net/gml" || uri == "http://www.opengis.net/gml/3.2")
    return {Ns::Gml};
  if (uri == "http://www.opengis.net/wfs" || uri == "http://www.opengis.net/wfs/2.0")
    return {Ns::Wfs};
  return {Ns::Foreign};
}

ElementName element_name(Ns ns, std::string_view name) {
  ElementName element{.ns = ns};
  switch (ns) {
    case Ns::Core:
    case Ns::Building:
    case Ns::Construction:
      if (const auto property = lod_property(ns, name)) return *property;
      element.tag = ns == Ns::Core       ? tag_of(kCoreNames, name)
                    : ns == Ns::Building ? tag_of(kBuildingNames, name)
                                         : tag_of(kConstructionNames, name);
      if (element.tag == Tag::Other || element.tag == Tag::BoundarySurface)
        if (const auto surface = surface_of(name)) {
          element.tag = Tag::BoundarySurface;
          element.surface = *surface;
        }
      break;
    case Ns::Generics:
      element.tag = tag_of(kGenericNames, name);
      break;
    case Ns::Gml:
      element.tag = tag_of(kGmlNames, name);
      break;
    case Ns::Wfs:
      element.tag = tag_of(kWfsNames, name);
      break;
    case Ns::Appearance:
      element.tag = Tag::Skipped;
      break;
    case Ns::OtherModule:
      // Legacy textured surfaces wrap the surface that they paint.
      if (name == "TexturedSurface") element = {.ns = Ns::Gml, .tag = Tag::OrientableSurface};
      break;
    case Ns::None:
    case Ns::Foreign:
      break;
  }
  return element;
}

}  // namespace citymesh::source
