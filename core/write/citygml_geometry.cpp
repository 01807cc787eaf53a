#include "core/write/citygml_geometry.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/write/citygml_features.h"
#include "core/write/extent.h"
#include "core/write/solids.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};

bool is_opening(SurfaceType type) {
  return type == SurfaceType::Window || type == SurfaceType::Door;
}

/// Faces of one (type, source surface, rung that made it).
struct Surface {
  SurfaceType type = SurfaceType::Unknown;
  std::string id{};
  std::string_view made_by{};
  std::vector<std::size_t> faces{};
  std::vector<std::size_t> openings{};  ///< surfaces that lie in this one
};

/// Which surface an opening lies in: the one that most of its edges are shared with.
class Hosts {
 public:
  Hosts(const TriangleMesh& mesh, const std::vector<std::size_t>& surface_of_face,
        const std::vector<Surface>& surfaces)
      : mesh_(mesh) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const std::size_t s = surface_of_face[f];
      if (s == kNone || is_opening(surfaces[s].type)) continue;
      for_each_edge(f, [&](std::uint32_t a, std::uint32_t b) { surface_at_[{b, a}] = s; });
    }
  }

  /// kNone: no other surface touches it.
  std::size_t host_of(const Surface& opening) const {
    std::map<std::size_t, std::size_t> edges;
    for (const std::size_t f : opening.faces)
      for_each_edge(f, [&](std::uint32_t a, std::uint32_t b) {
        if (const auto at = surface_at_.find({a, b}); at != surface_at_.end()) ++edges[at->second];
      });
    std::size_t host = kNone, most = 0;
    for (const auto& [surface, count] : edges)
      if (count > most) {
        host = surface;
        most = count;
      }
    return host;
  }

 private:
  template <class Visit>
  void for_each_edge(std::size_t f, Visit&& visit) const {
    for (const Ring& ring : mesh_.faces[f].rings)
      for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  }

  const TriangleMesh& mesh_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> surface_at_{};
};

class Builder {
 public:
  Builder(CityGml version, const CityObject& object, const Point3& origin, GmlIds& ids)
      : version_(version),
        object_(object),
        mesh_(object.body->mesh),
        origin_(origin),
        ids_(ids, object.body->name),
        lod_(solid_lod(*object.body)[0] - '0') {
    if (version == CityGml::V3) lod_ = std::min(lod_, 3);
    if (version == CityGml::V2 && object.kind == ObjectKind::BuildingInstallation)
      lod_ = std::max(lod_, 2);
    lod_ = std::clamp(lod_, 1, 4);
    group();
  }

  int lod() const { return lod_; }

  std::string boundaries() {
    std::string xml;
    const std::string_view property = version_ == CityGml::V2 ? "bldg:boundedBy" : "boundary";
    for (const Surface& surface : surfaces_) {
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
  bool holds(SurfaceType type) const {
    if (type == SurfaceType::Unknown) return false;
    if (version_ == CityGml::V3) return true;
    return lod_ >= (is_opening(type) ? 3 : 2);
  }

  void group() {
    surface_of_face_.assign(mesh_.faces.size(), kNone);
    polygon_ids_.resize(mesh_.faces.size());
    std::map<std::tuple<SurfaceType, std::uint32_t, std::string_view>, std::size_t> known;
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      const Face& face = mesh_.faces[f];
      const std::string_view source = face.source < mesh_.surface_ids.size()
                                          ? std::string_view(mesh_.surface_ids[face.source])
                                          : std::string_view();
      if (!holds(face.type)) {
        polygon_ids_[f] = ids_.take(source, 'p', f);
        continue;
      }
      const auto [at, is_new] =
          known.try_emplace({face.type, face.source, face.made_by}, surfaces_.size());
      if (is_new)
        surfaces_.push_back(
            {face.type, ids_.take(source, 'b', surfaces_.size()), face.made_by, {}, {}});
      surfaces_[at->second].faces.push_back(f);
      surface_of_face_[f] = at->second;
    }
    // Behind all ids that stay as they are.
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
      if (polygon_ids_[f].empty()) polygon_ids_[f] = ids_.generated('p', f);
    place_openings();
  }

  void place_openings() {
    const std::size_t count = surfaces_.size();
    if (std::none_of(surfaces_.begin(), surfaces_.end(),
                     [](const Surface& surface) { return is_opening(surface.type); }))
      return;
    const Hosts hosts(mesh_, surface_of_face_, surfaces_);
    for (std::size_t s = 0; s < count; ++s) {
      if (!is_opening(surfaces_[s].type)) continue;
      std::size_t host = hosts.host_of(surfaces_[s]);
      // A closure of 3.0 is no surface of a construction: only those have openings.
      if (host != kNone && version_ == CityGml::V3 &&
          surfaces_[host].type == SurfaceType::ClosureSurface)
        host = kNone;
      if (host == kNone) {  // the schema wants one: a wall that is nothing but its opening
        host = surfaces_.size();
        surfaces_.push_back({SurfaceType::WallSurface, ids_.generated('h', s), {}, {}, {}});
      }
      surfaces_[host].openings.push_back(s);
    }
  }

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

  void append_surface(std::string& xml, const Surface& surface) {
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
      append_surface(xml, surfaces_[s]);
      xml += "</";
      xml += opening;
      xml += ">\n";
    }
    xml += "</" + name + ">\n";
  }

  void append_polygon(std::string& xml, std::size_t f) {
    const Face& face = mesh_.faces[f];
    xml += "<gml:surfaceMember>\n<gml:Polygon gml:id=\"" + polygon_ids_[f] + "\">\n";
    if (surface_of_face_[f] == kNone) {  // the type has no element here
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
      if (surface_of_face_[f] == kNone) {
        append_polygon(xml, f);
      } else {
        xml += "<gml:surfaceMember xlink:href=\"#" + polygon_ids_[f] + "\"/>\n";
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
  int lod_;
  std::vector<Surface> surfaces_{};
  std::vector<std::size_t> surface_of_face_{};
  std::vector<std::string> polygon_ids_{};
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
