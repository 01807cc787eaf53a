#include "tests/support/citydb/geometry_properties.h"

#include <nlohmann/json.hpp>

namespace citymesh::citydb_support {
namespace {

std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

}  // namespace

GeometryProperties::GeometryProperties(Type type, const std::string& id)
    : head_("{\"type\":" + std::to_string(type) + ",\"objectId\":" + quoted(id)) {}

void GeometryProperties::begin_child(Type type, const std::string& id, int parent) {
  if (child_count_++ > 0) children_ += ',';
  children_ += "{\"type\":" + std::to_string(type) + ",\"objectId\":" + quoted(id);
  if (parent != kRoot) children_ += ",\"parent\":" + std::to_string(parent);
}

int GeometryProperties::add(Type type, const std::string& id, int parent) {
  begin_child(type, id, parent);
  children_ += '}';
  return child_count_ - 1;
}

void GeometryProperties::add_polygon(const std::string& id, int parent, bool reversed) {
  begin_child(Polygon, id, parent);
  children_ += ",\"geometryIndex\":" + std::to_string(polygon_count_++);
  if (reversed) children_ += ",\"isReversed\":true";
  children_ += '}';
}

std::string GeometryProperties::text() const {
  return head_ + (child_count_ > 0 ? ",\"children\":[" + children_ + "]}" : "}");
}

}  // namespace citymesh::citydb_support
