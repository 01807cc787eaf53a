#pragma once

#include <cstdint>
#include <string_view>

#include "core/citymodel/building.h"

namespace citymesh::source {

/// Namespaces by what they mean; the version is kept apart.
enum class Ns : std::uint8_t {
  None,
  Core,
  Building,
  Construction,  ///< CityGML 3.0
  Generics,
  Appearance,
  OtherModule,  ///< of CityGML
  Gml,
  Wfs,
  Foreign,  ///< application domain extensions and everything else
};

struct NsMeaning {
  Ns ns = Ns::Foreign;
  char citygml_major = 0;  ///< '1', '2', '3' where the URI tells
};
NsMeaning namespace_of(std::string_view uri);

/// What an element means to the reader, whatever the version calls it.
enum class Tag : std::uint8_t {
  Other,
  CityModel,
  FeatureCollection,
  MemberProperty,
  Building,
  BuildingPart,
  EnvelopeProperty,      ///< gml:boundedBy
  BoundaryProperty,      ///< bldg:boundedBy, core:boundary
  PartProperty,          ///< consistsOfBuildingPart, buildingPart
  InstallationProperty,  ///< outer installations
  Installation,
  Interior,          ///< rooms, furniture, interior installations, storeys
  OpeningProperty,   ///< opening, fillingSurface
  FillingProperty,   ///< filling: the volume of a window or door
  BoundarySurface,   ///< `surface` tells which
  GeometryProperty,  ///< lodNSolid, lodNMultiSurface, lod0FootPrint …
  ImplicitProperty,  ///< lodNImplicitRepresentation
  Implicit,
  Matrix,
  RelativeGeometry,
  ReferencePoint,
  UnusedGeometry,   ///< curves, terrain intersection
  GenericProperty,  ///< genericAttribute of 3.0
  GenericText,      ///< stringAttribute, dateAttribute, uriAttribute
  GenericWhole,     ///< intAttribute
  GenericNumber,    ///< doubleAttribute, measureAttribute
  GenericSet,       ///< genericAttributeSet
  Name,
  Value,
  AddressProperty,
  Address,
  XalProperty,
  HeightProperty,  ///< con:height
  Height,
  Skipped,  ///< appearance, references: known and of no use here
  Envelope,
  LowerCorner,
  UpperCorner,
  // Geometry elements.
  Polygon,  ///< Polygon, PolygonPatch, Triangle, Rectangle
  Ring,     ///< LinearRing, Ring
  Solid,
  CompositeSolid,
  MultiSolid,
  CompositeSurface,  ///< CompositeSurface, Shell, Surface, PolyhedralSurface, TriangulatedSurface
  MultiSurface,      ///< MultiSurface, MultiGeometry, GeometricComplex
  OrientableSurface,
  // Geometry properties.
  GeometryMember,  ///< surfaceMember, solidMember, baseSurface, patches …
  Exterior,
  InteriorBoundary,
  Coordinates,  ///< posList
  Position,     ///< pos
  Tuples,       ///< coordinates
};

struct ElementName {
  Ns ns = Ns::Foreign;
  Tag tag = Tag::Other;
  std::int8_t lod = -1;
  bool footprint = false;
  SurfaceType surface = SurfaceType::Unknown;
};

ElementName element_name(Ns ns, std::string_view local_name);

}  // namespace citymesh::source
