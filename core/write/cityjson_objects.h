#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>

#include "core/citymodel/mesh.h"
#include "core/write/city_objects.h"
#include "core/write/extent.h"
#include "core/write/write.h"

namespace citymesh {

/// City objects and their vertices as CityJSON text; grows with every building.
class CityJsonObjects {
 public:
  /// `line_break` stands between objects and between vertices.
  explicit CityJsonObjects(std::string_view line_break) : line_break_(line_break) {}

  /// The building, its parts and installations, each with its polygons. Returns the id that the
  /// building got: a missing or repeated gml_id is replaced.
  std::string append(const BuildingBodies& building);

  const std::string& objects() const { return objects_; }    ///< `"id":{…},"id":{…}`
  const std::string& vertices() const { return vertices_; }  ///< `[x,y,z],[x,y,z]`
  const GridExtent& extent() const { return extent_; }       ///< of everything so far

  void clear_text();        ///< what follows continues objects and vertices
  void restart_vertices();  ///< what follows starts objects and vertices of its own

 private:
  void append_object(const CityObject& object, const std::string& id, std::string_view relations);
  void append_geometry(const Body& body);
  void append_vertices(const Body& body);
  std::string unused_id(const std::string& gml_id, const std::string& fallback);

  std::string_view line_break_;
  std::string objects_{};
  std::string vertices_{};
  std::uint64_t next_vertex_ = 0;
  bool any_object_ = false;
  std::unordered_set<std::string> used_{};  ///< ids are keys, each may be there once
  GridExtent extent_{};
};

/// `"type":"CityJSON","version":"2.0","transform":…` as both forms begin.
std::string cityjson_head(const Scene& scene);

/// The object `metadata`; `extent` is left out while it is empty.
std::string cityjson_metadata(const Scene& scene, const GridExtent& extent);

}  // namespace citymesh
