#include <algorithm>
#include <optional>

#include "core/write/citygml_features.h"
#include "core/write/citygml_geometry.h"
#include "core/write/extent.h"
#include "core/write/output.h"
#include "core/write/text.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

constexpr std::string_view kRoot2 =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\" "
    "xmlns:bldg=\"http://www.opengis.net/citygml/building/2.0\" "
    "xmlns:gen=\"http://www.opengis.net/citygml/generics/2.0\" "
    "xmlns:gml=\"http://www.opengis.net/gml\" "
    "xmlns:xAL=\"urn:oasis:names:tc:ciq:xsdschema:xAL:2.0\" "
    "xmlns:xlink=\"http://www.w3.org/1999/xlink\" gml:id=\"cm.model\">\n";
constexpr std::string_view kRoot3 =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<CityModel xmlns=\"http://www.opengis.net/citygml/3.0\" "
    "xmlns:bldg=\"http://www.opengis.net/citygml/building/3.0\" "
    "xmlns:con=\"http://www.opengis.net/citygml/construction/3.0\" "
    "xmlns:gen=\"http://www.opengis.net/citygml/generics/3.0\" "
    "xmlns:gml=\"http://www.opengis.net/gml/3.2\" "
    "xmlns:xAL=\"urn:oasis:names:tc:ciq:xal:3\" "
    "xmlns:xlink=\"http://www.w3.org/1999/xlink\" gml:id=\"cm.model\">\n";

/// "EPSG:25833" as OGC's URN, "EPSG:25833+5783" as that of a compound CRS; empty when there is none
/// to state.
std::string crs_urn(const Crs& crs) {
  const auto colon = crs.id.find(':');
  if (!crs.known() || colon == std::string::npos) return {};
  const std::string authority = crs.id.substr(0, colon);
  const std::string version = authority == "OGC" ? "1.3" : "";
  const std::string part = "crs:" + authority + ':' + version + ':';
  const auto plus = crs.id.find('+', colon);
  const std::string horizontal = part + crs.id.substr(colon + 1, plus - colon - 1);
  if (plus == std::string::npos) return "urn:ogc:def:" + horizontal;
  return "urn:ogc:def:crs," + horizontal + ',' + part + crs.id.substr(plus + 1);
}

class CityGmlWriter final : public BodyWriter {
 public:
  CityGmlWriter(AtomicFile file, CityGml version, Scene scene)
      : file_(std::move(file)), version_(version), scene_(std::move(scene)) {}

  Result<std::string> encode(const BuildingBodies& building) const override {
    GmlIds ids;
    GridExtent extent;
    const std::string member = member_of(building, ids, extent);
    return head(extent) + member + std::string(kTail);
  }

  Result<void> begin() { return file_.write(head({})); }

  Result<void> add(const BuildingBodies& building) override {
    return file_.write(member_of(building, ids_, extent_));
  }

  Result<void> finish() override {
    if (auto r = file_.write(kTail); !r) return r;
    if (auto r = file_.overwrite(0, head(extent_)); !r) return r;
    return file_.commit();
  }

 private:
  static constexpr std::string_view kTail = "</CityModel>\n";
  static constexpr std::size_t kCornerBytes = 3 * 20;  ///< room for a corner that comes last

  /// Has the same length for every extent: it is written first and again when the extent is known.
  std::string head(const GridExtent& extent) const {
    std::string xml(version_ == CityGml::V2 ? kRoot2 : kRoot3);
    xml += "<gml:description>";
    append_markup(xml, scene_text(scene_));
    xml += "</gml:description>\n<gml:boundedBy>\n<gml:Envelope";
    if (const std::string urn = crs_urn(scene_.crs); !urn.empty()) {
      xml += " srsName=\"";
      append_markup(xml, urn);
      xml += '"';
    }
    xml += " srsDimension=\"3\">\n";
    append_corner(xml, "gml:lowerCorner", extent.min);
    append_corner(xml, "gml:upperCorner", extent.max);
    return xml + "</gml:Envelope>\n</gml:boundedBy>\n";
  }

  void append_corner(std::string& xml, const std::string& name, const GridPoint& p) const {
    xml += '<' + name + '>';
    std::string corner;
    append_grid(corner, absolute_steps(scene_.origin.x, p.x));
    corner += ' ';
    append_grid(corner, absolute_steps(scene_.origin.y, p.y));
    corner += ' ';
    append_grid(corner, absolute_steps(scene_.origin.z, p.z));
    corner.resize(std::max(corner.size(), kCornerBytes), ' ');
    xml += corner + "</" + name + ">\n";
  }

  std::string member_of(const BuildingBodies& building, GmlIds& ids, GridExtent& extent) const {
    for (const Body& body : building.bodies) extent.add(body.mesh);
    const std::vector<CityObject> objects = city_objects(building);
    std::vector<std::string> object_ids;
    for (const CityObject& object : objects)
      object_ids.push_back(ids.take(object.gml_id, object.body ? object.body->name : "building"));

    std::string installations, parts;
    for (std::size_t i = 1; i < objects.size(); ++i) {
      const bool part = objects[i].kind == ObjectKind::BuildingPart;
      const std::string_view property =
          part ? version_ == CityGml::V2 ? "bldg:consistsOfBuildingPart" : "bldg:buildingPart"
          : version_ == CityGml::V2 ? "bldg:outerBuildingInstallation"
                                    : "bldg:buildingInstallation";
      std::string& xml = part ? parts : installations;
      xml += '<';
      xml += property;
      xml += ">\n" + object_xml(objects[i], object_ids[i], "", ids, {}, {});
      xml += "</";
      xml += property;
      xml += ">\n";
    }
    return "<cityObjectMember>\n" +
           object_xml(objects[0], object_ids[0], building.rung, ids, installations, parts) +
           "</cityObjectMember>\n";
  }

  /// An object with what belongs to it, already written, in the order of the schema.
  std::string object_xml(const CityObject& object, const std::string& id, std::string_view rung,
                         GmlIds& ids, const std::string& installations,
                         const std::string& parts) const {
    const std::string name = "bldg:" + std::string(to_string(object.kind));
    std::string xml = '<' + name + " gml:id=\"" + id + "\">\n";
    append_attributes_before_geometry(xml, version_, object, rung);
    std::optional<GmlGeometry> geometry;
    if (object.body) geometry.emplace(version_, object, scene_.origin, ids);
    if (version_ == CityGml::V3) {
      if (geometry) xml += geometry->boundaries() + geometry->solid();
      append_attributes_after_geometry(xml, version_, object);
      xml += installations;
    } else {
      // Solids of LoD1 and LoD2 stand before boundary surfaces, later ones behind; an installation
      // has its geometry first.
      const bool first =
          !geometry || geometry->lod() <= 2 || object.kind == ObjectKind::BuildingInstallation;
      if (geometry && first) xml += geometry->solid();
      xml += installations;
      if (geometry) xml += geometry->boundaries();
      if (geometry && !first) xml += geometry->solid();
    }
    const bool has_addresses = object.kind != ObjectKind::BuildingInstallation;
    std::string addresses;
    if (has_addresses)
      append_gml_addresses(addresses, version_, *object.addresses,
                           "cm." + address_name(object, id));
    xml += version_ == CityGml::V2 ? parts + addresses : addresses + parts;
    return xml + "</" + name + ">\n";
  }

  static std::string address_name(const CityObject& object, const std::string& id) {
    return (object.body ? object.body->name : "of-" + id) + ".a";
  }

  AtomicFile file_;
  CityGml version_;
  Scene scene_;
  GmlIds ids_{};
  GridExtent extent_{};
};

WriterResult open_citygml(const std::filesystem::path& folder, const Format& format,
                          const Scene& scene, CityGml version) {
  auto file = AtomicFile::create(folder / format.file_name);
  if (!file) return file.error();
  auto writer = std::make_unique<CityGmlWriter>(std::move(*file), version, scene);
  if (auto begun = writer->begin(); !begun) return begun.error();
  return WriterResult(std::move(writer));
}

}  // namespace

WriterResult open_citygml2(const std::filesystem::path& folder, const Format& format,
                           const Scene& scene) {
  return open_citygml(folder, format, scene, CityGml::V2);
}

WriterResult open_citygml3(const std::filesystem::path& folder, const Format& format,
                           const Scene& scene) {
  return open_citygml(folder, format, scene, CityGml::V3);
}

}  // namespace citymesh
