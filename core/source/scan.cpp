#include "core/source/scan.h"
#include "core/source/citygml_shapes.h"

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
      if (object.kind == ObjectKind::BuildingInstallation) continue;
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

BuildingRecord summary(const Feature& feature) {
  BuildingRecord building;
  building.gml_id = feature.objects.front().gml_id;
  building.srs = feature.srs;
  building.bytes = feature.bytes;
  building.envelope = feature.envelope;
  building.borrowed.assign(feature.borrowed.begin(), feature.borrowed.end());
  for (std::size_t i = 1; i < feature.objects.size(); ++i)
    if (!feature.objects[i].inside) building.part_ids.push_back(feature.objects[i].gml_id);
  for (const RawObject& object : feature.objects) {
    if (object.kind == ObjectKind::BuildingInstallation) continue;
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
  }
  return building;
}

Result<void> read_through(FileScan& scan, DocumentOptions options, bool with_footprints) {
  scan.records.clear();
  scan.has_footprints = with_footprints;
  options.shared = scan.shared.get();
  return read_document(scan.text, *scan.format, options, scan.facts,
                       [&](Feature& feature) -> Result<void> {
                         BuildingRecord building = summary(feature);
                         building.number = scan.records.size();
                         if (!scan.records.empty() && building.bytes.known() &&
                             building.bytes == scan.records.back().bytes)
                           building.nth_of_piece = scan.records.back().nth_of_piece + 1;
                         if (with_footprints) building.footprint = footprints_of(feature);
                         scan.records.push_back(std::move(building));
                         return {};
                       });
}

Result<void> find_shared_geometry(FileScan& scan, const DocumentOptions& options) {
  auto shared = std::make_shared<SharedGeometry>();
  DocumentFacts facts;
  facts.srs_names = std::move(scan.facts.srs_names);
  std::set<std::string, std::less<>> wanted = std::move(scan.facts.unresolved);
  constexpr int kMaxHops = 4;  // what is borrowed may borrow in turn
  for (int hop = 0; hop < kMaxHops && !wanted.empty(); ++hop) {
    auto bytes = ByteReader::open(scan.text, options.limits.max_file_bytes);
    if (!bytes) return {};
    const std::size_t before = shared->by_id.size();
    facts.unresolved.clear();
    if (auto collected = collect_shared_geometry(*bytes, options, wanted, facts, *shared);
        !collected)
      return collected;
    if (shared->by_id.size() == before) break;
    wanted = std::move(facts.unresolved);
    facts.unresolved.clear();
  }
  scan.facts = {};
  scan.facts.srs_names = std::move(facts.srs_names);
  scan.facts.envelopes = std::move(facts.envelopes);
  for (const auto& [id, place] : shared->places) scan.shared_places.emplace(id, place);
  scan.shared = std::move(shared);
  return {};
}

// No building of a city is further from the middle of it.
constexpr double kAstray_m = 200'000.0;
constexpr double kAstray_deg = 2.0;

Point2 centre_of(const Box3& box) {
  return {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2};
}

// The extent without the boxes that are far from the median centre: one stray building must not
// move the origin.
Box3 robust_extent(const std::vector<const Box3*>& boxes, double max_distance) {
  std::vector<double> xs, ys;
  for (const Box3* box : boxes) {
    xs.push_back(centre_of(*box).x);
    ys.push_back(centre_of(*box).y);
  }
  const auto middle = static_cast<std::ptrdiff_t>(boxes.size() / 2);
  std::nth_element(xs.begin(), xs.begin() + middle, xs.end());
  std::nth_element(ys.begin(), ys.begin() + middle, ys.end());
  const double x = xs[boxes.size() / 2], y = ys[boxes.size() / 2];
  Box3 extent;
  for (const Box3* box : boxes)
    if (box->min.x >= x - max_distance && box->max.x <= x + max_distance &&
        box->min.y >= y - max_distance && box->max.y <= y + max_distance)
      extent.add(*box);
  return extent;
}

void sum_up(FileScan& scan) {
  scan.buildings = scan.records.size();
  scan.srs.assign(scan.facts.srs_names.size(), {});
  for (std::uint32_t s = 0; s < scan.srs.size(); ++s) {
    std::vector<const Box3*> boxes;
    for (const BuildingRecord& building : scan.records)
      if (building.srs == s && !building.extent.is_empty()) boxes.push_back(&building.extent);
    if (boxes.empty()) continue;
    SrsExtent& srs = scan.srs[s];
    srs.buildings = boxes.size();
    for (const Box3* box : boxes) srs.all.add(*box);
    srs.near_m = robust_extent(boxes, kAstray_m);
    srs.near_deg = robust_extent(boxes, kAstray_deg);
  }
}

}  // namespace

Footprints footprints_of(const Feature& feature) {
  Footprints footprints;
  FootprintFinder(feature).add_to(footprints);
  return footprints;
}

FileRecord plain_file(const std::filesystem::path& path) {
  return {.path = path, .name = path.filename().string(), .text = path};
}

Result<FileScan> scan_file(FileRecord file, const ReadLimits& limits, bool with_footprints,
                           const std::stop_token& stop) {
  FileScan scan{std::move(file)};
  if (!scan.facts.failure.empty()) {  // known before it is opened
    sum_up(scan);
    return scan;
  }
  const auto format = detect_format(scan.text, scan.name, limits);
  if (!format) {
    scan.facts.failure = format.error().message;
    scan.facts.not_a_city_model = format.error().code == ErrorCode::InvalidArgument;
    sum_up(scan);
    return scan;
  }
  scan.format = *format;
  const DocumentOptions options{.limits = limits, .stem = file_stem(scan.name), .stop = stop};
  const auto packed = is_gzip(scan.text);
  const bool in_pieces = packed && !*packed;
  if (auto read = read_through(scan, options, with_footprints); !read) return read.error();
  if (!scan.facts.unresolved.empty()) {
    // Some features refer to geometry of others: find it and look again.
    if (auto found = find_shared_geometry(scan, options); !found) return found.error();
    if (auto read = read_through(scan, options, with_footprints); !read) return read.error();
  }
  if (!in_pieces)  // places in the unpacked text lead nowhere
    for (BuildingRecord& building : scan.records) building.bytes = {};
  sum_up(scan);
  return scan;
}

}  // namespace citymesh::source
