#pragma once

#include <cstddef>
#include <string>

namespace citymesh::citydb_support {

/// The JSON beside a geometry of version 5: what it is made of, with ids.
class GeometryProperties {
 public:
  enum Type : int {
    Polygon = 5,
    CompositeSurface = 6,
    TriangulatedSurface = 7,
    MultiSurface = 8,
    Solid = 9,
    CompositeSolid = 10,
    MultiSolid = 11,
  };
  static constexpr int kRoot = -1;

  GeometryProperties(Type type, const std::string& id);
  /// A surface or solid below the root or another child; its number.
  int add(Type type, const std::string& id, int parent);
  void add_polygon(const std::string& id, int parent, bool reversed);
  std::string text() const;

 private:
  void begin_child(Type type, const std::string& id, int parent);

  std::string head_{};
  std::string children_{};
  int child_count_ = 0, polygon_count_ = 0;
};

}  // namespace citymesh::citydb_support
