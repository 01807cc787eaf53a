#include "core/geometry/overlay.h"

#define GEOS_USE_ONLY_R_API
#include <geos_c.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

namespace citymesh {
namespace {

// GEOS 3.11 works in doubles; with a precision of one step OverlayNG snap-rounds to whole steps,
// and every coordinate up to kGridLimit is exact in a double.
constexpr double kPrecision = 1.0;

class Geos {
 public:
  Geos() : handle_(GEOS_init_r()) {
    GEOSContext_setErrorMessageHandler_r(
        handle_,
        [](const char* message, void* self) { static_cast<Geos*>(self)->message_ = message; },
        this);
  }
  ~Geos() { GEOS_finish_r(handle_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  GEOSContextHandle_t handle() const { return handle_; }
  Error error(const char* verb) const {
    return fail(ErrorCode::Internal, std::string("overlay: ") + verb + " gave up: " + message_);
  }

 private:
  GEOSContextHandle_t handle_;
  std::string message_ = "no reason given";
};

struct Destroy {
  GEOSContextHandle_t handle;
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(handle, geometry); }
};
using GeometryPtr = std::unique_ptr<GEOSGeometry, Destroy>;

GEOSGeometry* ring_of(const Geos& geos, std::span<const GridPoint2> ring) {
  auto* sequence = GEOSCoordSeq_create_r(geos.handle(), static_cast<unsigned>(ring.size() + 1), 2);
  for (unsigned i = 0; i <= ring.size(); ++i) {
    const GridPoint2& p = ring[i % ring.size()];
    GEOSCoordSeq_setXY_r(geos.handle(), sequence, i, static_cast<double>(p.x),
                         static_cast<double>(p.y));
  }
  return GEOSGeom_createLinearRing_r(geos.handle(), sequence);
}

GeometryPtr collection_of(const Geos& geos, std::span<const Area> areas) {
  std::vector<GEOSGeometry*> members;
  members.reserve(areas.size());
  for (const Area& area : areas) {
    if (area.exterior.size() < 3) continue;
    std::vector<GEOSGeometry*> holes;
    for (const auto& hole : area.holes)
      if (hole.size() >= 3) holes.push_back(ring_of(geos, hole));
    members.push_back(GEOSGeom_createPolygon_r(geos.handle(), ring_of(geos, area.exterior),
                                               holes.data(), static_cast<unsigned>(holes.size())));
  }
  return {GEOSGeom_createCollection_r(geos.handle(), GEOS_GEOMETRYCOLLECTION, members.data(),
                                      static_cast<unsigned>(members.size())),
          Destroy{geos.handle()}};
}

std::vector<GridPoint2> ring_from(const Geos& geos, const GEOSGeometry* ring,
                                  bool counter_clockwise) {
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(geos.handle(), ring);
  unsigned size = 0;
  GEOSCoordSeq_getSize_r(geos.handle(), sequence, &size);
  std::vector<GridPoint2> points;
  for (unsigned i = 0; i + 1 < size; ++i) {
    double x = 0, y = 0;
    GEOSCoordSeq_getXY_r(geos.handle(), sequence, i, &x, &y);
    const GridPoint2 p{std::llround(x), std::llround(y)};
    if (points.empty() || points.back() != p) points.push_back(p);
  }
  if (points.size() < 3) return {};
  if ((area2({points, {}}) > 0) != counter_clockwise) std::reverse(points.begin(), points.end());
  std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
  return points;
}

void collect(const Geos& geos, const GEOSGeometry* geometry, std::vector<Area>& out) {
  const int type = GEOSGeomTypeId_r(geos.handle(), geometry);
  if (type == GEOS_POLYGON) {
    if (GEOSisEmpty_r(geos.handle(), geometry)) return;
    Area area;
    area.exterior = ring_from(geos, GEOSGetExteriorRing_r(geos.handle(), geometry), true);
    if (area.exterior.empty()) return;
    const int holes = GEOSGetNumInteriorRings_r(geos.handle(), geometry);
    for (int i = 0; i < holes; ++i) {
      auto hole = ring_from(geos, GEOSGetInteriorRingN_r(geos.handle(), geometry, i), false);
      if (!hole.empty()) area.holes.push_back(std::move(hole));
    }
    std::sort(area.holes.begin(), area.holes.end());
    out.push_back(std::move(area));
  } else if (type == GEOS_MULTIPOLYGON || type == GEOS_GEOMETRYCOLLECTION) {
    const int parts = GEOSGetNumGeometries_r(geos.handle(), geometry);
    for (int i = 0; i < parts; ++i)
      collect(geos, GEOSGetGeometryN_r(geos.handle(), geometry, i), out);
  }
}

std::vector<Area> areas_of(const Geos& geos, const GEOSGeometry* geometry) {
  std::vector<Area> areas;
  collect(geos, geometry, areas);
  std::sort(areas.begin(), areas.end(),
            [](const Area& a, const Area& b) { return a.exterior < b.exterior; });
  return areas;
}

}  // namespace

Int128 area2(const Area& area) {
  const auto ring = [](const std::vector<GridPoint2>& points) {
    Int128 sum = 0;
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      sum += area2(points[0], points[i], points[i + 1]);
    return sum;
  };
  Int128 sum = ring(area.exterior);
  for (const auto& hole : area.holes) sum += ring(hole);
  return sum;
}

Result<std::vector<Area>> unite(std::span<const Area> areas) {
  Geos geos;
  const GeometryPtr all = collection_of(geos, areas);
  const GeometryPtr united{GEOSUnaryUnionPrec_r(geos.handle(), all.get(), kPrecision),
                           Destroy{geos.handle()}};
  if (!united) return geos.error("union");
  return areas_of(geos, united.get());
}

Result<std::vector<Area>> subtract(std::span<const Area> minuend,
                                   std::span<const Area> subtrahend) {
  Geos geos;
  const GeometryPtr all_a = collection_of(geos, minuend), all_b = collection_of(geos, subtrahend);
  const GeometryPtr a{GEOSUnaryUnionPrec_r(geos.handle(), all_a.get(), kPrecision),
                      Destroy{geos.handle()}};
  const GeometryPtr b{GEOSUnaryUnionPrec_r(geos.handle(), all_b.get(), kPrecision),
                      Destroy{geos.handle()}};
  if (!a || !b) return geos.error("union");
  const GeometryPtr rest{GEOSDifferencePrec_r(geos.handle(), a.get(), b.get(), kPrecision),
                         Destroy{geos.handle()}};
  if (!rest) return geos.error("difference");
  return areas_of(geos, rest.get());
}

Result<std::vector<Area>> simplify(std::span<const Area> areas, double tolerance_m) {
  Geos geos;
  const GeometryPtr all = collection_of(geos, areas);
  const GeometryPtr fewer{
      GEOSTopologyPreserveSimplify_r(geos.handle(), all.get(), tolerance_m * kGridStepsPerMetre),
      Destroy{geos.handle()}};
  if (!fewer) return geos.error("simplification");
  return areas_of(geos, fewer.get());
}

Result<std::vector<Area>> smooth(std::span<const Area> areas, double width_m) {
  constexpr double kMitreLimit = 5.0;
  constexpr int kQuadrantSegments = 4;
  Geos geos;
  const GeometryPtr all = collection_of(geos, areas);
  const auto buffered = [&](const GEOSGeometry* geometry, double width) {
    return GeometryPtr{
        GEOSBufferWithStyle_r(geos.handle(), geometry, width * kGridStepsPerMetre,
                              kQuadrantSegments, GEOSBUF_CAP_FLAT, GEOSBUF_JOIN_MITRE, kMitreLimit),
        Destroy{geos.handle()}};
  };
  const GeometryPtr wide = buffered(all.get(), width_m);
  if (!wide) return geos.error("closing");
  const GeometryPtr narrow = buffered(wide.get(), -2 * width_m);
  if (!narrow) return geos.error("opening");
  const GeometryPtr back = buffered(narrow.get(), width_m);
  if (!back) return geos.error("opening");
  const GeometryPtr gridded{GEOSUnaryUnionPrec_r(geos.handle(), back.get(), kPrecision),
                            Destroy{geos.handle()}};
  if (!gridded) return geos.error("rounding");
  return areas_of(geos, gridded.get());
}

Area convex_hull(std::vector<GridPoint2> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<GridPoint2> hull;
  const auto extend = [&hull](const GridPoint2& p, std::size_t keep) {
    while (hull.size() > keep + 1 && orient2d(hull[hull.size() - 2], hull.back(), p) <= 0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const GridPoint2& p : points) extend(p, 0);
  const std::size_t lower = hull.empty() ? 0 : hull.size() - 1;
  for (auto p = points.rbegin(); p != points.rend(); ++p)
    if (*p != points.back()) extend(*p, lower);
  if (hull.size() > 1) hull.pop_back();
  if (hull.size() < 3) return {};
  return {std::move(hull), {}};
}

}  // namespace citymesh
