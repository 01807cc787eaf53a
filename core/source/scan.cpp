#include "core/source/scan.h"

#include <algorithm>
#include <utility>

#include "core/source/byte_reader.h"
#include "core/source/citygml.h"

namespace citymesh::source {
namespace {

/// Which polygons an object is drawn with on a map: its ground surfaces, else its footprint, else
/// everything.
class FootprintFinder {
 public:
  explicit FootprintFinder(const Feature& feature) : feature_(feature) {
    taken_.assign(feature.polygons.size(), false);
  }

  void add_to(Footprints& footprints) {
    for (std::size_t i = 0; i < feature_.objects.size(); ++i) {
      const RawObject& object = feature_.objects[i];
      const auto is_ground = [&](const RawShape&, const RawPolygon& polygon) {
        return polygon.surface >= 0 && polygon.object == static_cast<std::int32_t>(i) &&
               object.surfaces[static_cast<std::size_t>(polygon.surface)].type ==
                   SurfaceType::GroundSurface;
      };
      const auto is_footprint = [](const RawShape& shape, const RawPolygon&) {
        return shape.footprint;
      };
      const auto any = [](const RawShape&, const RawPolygon&) { return true; };
      if (add(object, is_ground, footprints)) continue;
      if (add(object, is_footprint, footprints)) continue;
      add(object, any, footprints);
    }
  }

 private:
  template <class Rule>
  bool add(const RawObject& object, const Rule& rule, Footprints& footprints) {
    bool found = false;
    for (const RawShape& shape : object.shapes)
      for (const PolygonUse& use : shape.uses) {
        const RawPolygon& polygon = feature_.polygons[use.polygon];
        if (!rule(shape, polygon)) continue;
        found = true;
        if (taken_[use.polygon]) continue;
        taken_[use.polygon] = true;
        copy(polygon, footprints);
      }
    return found;
  }

  void copy(const RawPolygon& polygon, Footprints& footprints) {
    for (std::uint32_t r = 0; r < polygon.ring_count; ++r) {
      const RawRing ring = feature_.rings[polygon.first_ring + r];
      const auto first = static_cast<std::uint32_t>(footprints.points.size());
      for (std::uint32_t p = 0; p < ring.count; ++p) {
        const Point3& point = feature_.points[ring.first + p];
        const Point2 flat{point.x, point.y};
        if (footprints.points.size() > first && footprints.points.back() == flat) continue;
        footprints.points.push_back(flat);
      }
      const auto count = static_cast<std::uint32_t>(footprints.points.size()) - first;
      footprints.rings.push_back({first, count, r == 0});
    }
  }

  const Feature& feature_;
  std::vector<bool> taken_{};
};

ScannedBuilding summary(const Feature& feature) {
  ScannedBuilding building;
  building.gml_id = feature.objects.front().gml_id;
  building.srs = feature.srs;
  for (std::size_t i = 1; i < feature.objects.size(); ++i)
    building.part_ids.push_back(feature.objects[i].gml_id);
  for (const RawObject& object : feature.objects)
    for (const RawShape& shape : object.shapes)
      for (const PolygonUse& use : shape.uses) {
        const RawPolygon& polygon = feature.polygons[use.polygon];
        if (building.extent.is_empty()) building.srs = polygon.srs;
        for (std::uint32_t r = 0; r < polygon.ring_count; ++r) {
          const RawRing ring = feature.rings[polygon.first_ring + r];
          for (std::uint32_t p = 0; p < ring.count; ++p)
            building.extent.add(feature.points[ring.first + p]);
        }
      }
  return building;
}

Result<void> read_through(FileScan& scan, DocumentOptions options, bool with_footprints) {
  scan.buildings.clear();
  scan.footprints = {};
  scan.has_footprints = with_footprints;
  options.shared = scan.shared.get();
  return read_document(
      scan.path, *scan.format, options, scan.facts, [&](Feature& feature) -> Result<void> {
        ScannedBuilding& building = scan.buildings.emplace_back(summary(feature));
        if (!with_footprints) return {};
        building.first_ring = static_cast<std::uint32_t>(scan.footprints.rings.size());
        FootprintFinder(feature).add_to(scan.footprints);
        building.ring_count =
            static_cast<std::uint32_t>(scan.footprints.rings.size()) - building.first_ring;
        return {};
      });
}

}  // namespace

Result<FileScan> scan_file(const std::filesystem::path& path, const ReadLimits& limits,
                           bool with_footprints, const std::stop_token& stop) {
  FileScan scan{.path = path};
  const auto format = detect_format(path, limits);
  if (!format) {
    scan.facts.failure = format.error().message;
    scan.facts.not_a_city_model = format.error().code == ErrorCode::InvalidArgument;
    return scan;
  }
  scan.format = *format;
  const DocumentOptions options{.limits = limits, .stem = file_stem(path), .stop = stop};
  if (auto read = read_through(scan, options, with_footprints); !read) return read.error();
  if (scan.facts.unresolved.empty()) return scan;

  // Some features refer to geometry of others: find it and look again.
  auto shared = std::make_shared<SharedGeometry>();
  auto bytes = ByteReader::open(path, limits.max_file_bytes);
  if (!bytes) return scan;
  DocumentFacts facts;
  facts.srs_names = scan.facts.srs_names;
  if (auto collected =
          collect_shared_geometry(*bytes, options, scan.facts.unresolved, facts, *shared);
      !collected)
    return collected.error();
  if (shared->by_id.empty()) return scan;
  scan.shared = std::move(shared);
  scan.facts = {};
  scan.facts.srs_names = std::move(facts.srs_names);
  if (auto read = read_through(scan, options, with_footprints); !read) return read.error();
  return scan;
}

}  // namespace citymesh::source
