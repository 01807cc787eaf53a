#include "core/write/citygml_geometry.h"

#include <vector>

#include "core/write/boundaries.h"
#include "core/write/citygml_features.h"
#include "core/write/extent.h"
#include "core/write/solids.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

class Builder {
 public:
  Builder(CityGml version, const CityObject& object, const Point3& origin, GmlIds& ids)
      : version_(version),
        object_(object),
        mesh_(object.body->mesh),
        origin_(origin),
        ids_(ids, object.body->name),
        boundaries_(boundaries_of(version, object, ids_)),
        lod_(boundaries_.lod) {}

  int lod() const { return lod_; }

  std::string boundaries() {
    std::string xml;
    const std::string_view property = version_ == CityGml::V2 ? "bldg:boundedBy" : "boundary";
    for (const BoundarySurface& surface : boundaries_.surfaces) {
      if (is_opening(surface.type)) continue;
      xml += '<';
      xml += property;
      xml += ">\n";
      append_surface(xml, surface);
      xml += "</";
      xml += property;
      xml += ">\n";
    }
    return xml;
  }

  std::string solid() {
    const std::string property =
        (version_ == CityGml::V3 ? "lod" : "bldg:lod") + std::to_string(lod_) +
        (version_ == CityGml::V2 && object_.kind == ObjectKind::BuildingInstallation ? "Geometry"
                                                                                     : "Solid");
    const std::vector<SolidFaces> solids = solids_of(mesh_);
    std::string xml = '<' + property + ">\n";
    if (solids.size() > 1) xml += "<gml:CompositeSolid" + id('c', 0) + ">\n";
    for (std::size_t i = 0; i < solids.size(); ++i) {
      if (solids.size() > 1) xml += "<gml:solidMember>\n";
      xml += "<gml:Solid" + id('s', i) + ">\n";
      append_shell(xml, "gml:exterior", solids[i].exterior);
      for (const FaceRange& interior : solids[i].interiors)
        append_shell(xml, "gml:interior", interior);
      xml += "</gml:Solid>\n";
      if (solids.size() > 1) xml += "</gml:solidMember>\n";
    }
    if (solids.size() > 1) xml += "</gml:CompositeSolid>\n";
    return xml + "</" + property + ">\n";
  }

 private:
  std::string_view element(SurfaceType type) const {
    switch (type) {
      case SurfaceType::Window:
        return version_ == CityGml::V2 ? "bldg:Window" : "con:WindowSurface";
      case SurfaceType::Door:
        return version_ == CityGml::V2 ? "bldg:Door" : "con:DoorSurface";
      case SurfaceType::ClosureSurface:
        return version_ == CityGml::V2 ? "bldg:ClosureSurface" : "ClosureSurface";
      default:
        name_ = version_ == CityGml::V2 ? "bldg:" : "con:";
        name_ += to_string(type);
        return name_;
    }
  }

  void append_surface(std::string& xml, const BoundarySurface& surface) {
    const std::string name(element(surface.type));
    const std::string multi =
        (version_ == CityGml::V3 ? "lod" : "bldg:lod") + std::to_string(lod_) + "MultiSurface";
    const std::string_view opening =
        version_ == CityGml::V2 ? "bldg:opening" : "con:fillingSurface";
    xml += '<' + name + " gml:id=\"" + surface.id + "\">\n";
    if (!surface.made_by.empty())
      append_generic_attribute(xml, version_, "citymesh_rung", std::string(surface.made_by));
    if (!surface.faces.empty()) {
      xml += '<' + multi + ">\n<gml:MultiSurface" + id('m', multi_surfaces_++) + ">\n";
      for (const std::size_t f : surface.faces) append_polygon(xml, f);
      xml += "</gml:MultiSurface>\n</" + multi + ">\n";
    }
    for (const std::size_t s : surface.openings) {
      xml += '<';
      xml += opening;
      xml += ">\n";
      append_surface(xml, boundaries_.surfaces[s]);
      xml += "</";
      xml += opening;
      xml += ">\n";
    }
    xml += "</" + name + ">\n";
  }

  void append_polygon(std::string& xml, std::size_t f) {
    const Face& face = mesh_.faces[f];
    xml += "<gml:surfaceMember>\n<gml:Polygon gml:id=\"" + boundaries_.polygon_ids[f] + "\">\n";
    if (boundaries_.surface_of_face[f] == kNoBoundary) {  // the type has no element here
      xml += "<gml:name>";
      xml += to_string(face.type);
      xml += "</gml:name>\n";
    }
    for (std::size_t r = 0; r < face.rings.size(); ++r) {
      xml += r == 0 ? "<gml:exterior>" : "<gml:interior>";
      xml += "<gml:LinearRing><gml:posList srsDimension=\"3\">";
      const Ring& ring = face.rings[r];
      for (std::size_t i = 0; i <= ring.size(); ++i) {
        const GridPoint& p = mesh_.points[ring[i % ring.size()]];
        if (i > 0) xml += ' ';
        append_grid(xml, absolute_steps(origin_.x, p.x));
        xml += ' ';
        append_grid(xml, absolute_steps(origin_.y, p.y));
        xml += ' ';
        append_grid(xml, absolute_steps(origin_.z, p.z));
      }
      xml += "</gml:posList></gml:LinearRing>";
      xml += r == 0 ? "</gml:exterior>\n" : "</gml:interior>\n";
    }
    xml += "</gml:Polygon>\n</gml:surfaceMember>\n";
  }

  void append_shell(std::string& xml, std::string_view role, const FaceRange& faces) {
    const std::string_view shell = version_ == CityGml::V2 ? "gml:CompositeSurface" : "gml:Shell";
    xml += '<';
    xml += role;
    xml += ">\n<";
    xml += shell;
    xml += id('k', shells_++) + ">\n";
    for (std::size_t f = faces.begin; f < faces.end; ++f) {
      if (boundaries_.surface_of_face[f] == kNoBoundary) {
        append_polygon(xml, f);
      } else {
        xml += "<gml:surfaceMember xlink:href=\"#" + boundaries_.polygon_ids[f] + "\"/>\n";
      }
    }
    xml += "</";
    xml += shell;
    xml += ">\n</";
    xml += role;
    xml += ">\n";
  }

  std::string id(char kind, std::size_t number) {
    return " gml:id=\"" + ids_.generated(kind, number) + '"';
  }

  CityGml version_;
  const CityObject& object_;
  const TriangleMesh& mesh_;
  Point3 origin_;
  BodyIds ids_;
  Boundaries boundaries_;
  int lod_;
  mutable std::string name_{};
  std::size_t multi_surfaces_ = 0, shells_ = 0;
};

}  // namespace

GmlGeometry::GmlGeometry(CityGml version, const CityObject& object, const Point3& origin,
                         GmlIds& ids) {
  Builder builder(version, object, origin, ids);
  boundaries_ = builder.boundaries();
  solid_ = builder.solid();
  lod_ = builder.lod();
}

}  // namespace citymesh
