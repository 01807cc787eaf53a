#include "services/citydb/stored_geometry.h"

#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace citymesh::citydb {
namespace {

/// The nearest double of a whole number of steps divided by a whole number.
double coordinate(double origin_m, std::int64_t steps) {
  const auto first = static_cast<std::int64_t>(std::llround(origin_m * kGridStepsPerMetre));
  return static_cast<double>(first + steps) / kGridStepsPerMetre;
}

}  // namespace

void GeometryText::bytes(const void* from, std::size_t count) {
  static_assert(std::endian::native == std::endian::little);
  constexpr std::string_view kHex = "0123456789ABCDEF";
  const auto* const all = static_cast<const unsigned char*>(from);
  for (std::size_t i = 0; i < count; ++i) {
    hex_ += kHex[all[i] >> 4];
    hex_ += kHex[all[i] & 15];
  }
}

void GeometryText::whole(std::uint32_t value) { bytes(&value, sizeof value); }

void GeometryText::head(Type type) {
  constexpr std::uint32_t kHasZ = 0x80000000u, kHasSrid = 0x20000000u;
  const bool outermost = hex_.empty();
  hex_ += "01";  // little endian
  whole(static_cast<std::uint32_t>(type) | kHasZ | (outermost ? kHasSrid : 0u));
  if (outermost) whole(static_cast<std::uint32_t>(srid_));
}

void GeometryText::collection(Type type, std::size_t count) {
  head(type);
  whole(static_cast<std::uint32_t>(count));
}

Point3 GeometryText::place_of(std::uint32_t corner) const {
  const GridPoint& p = mesh_.points[corner];
  return {coordinate(origin_.x, p.x), coordinate(origin_.y, p.y), coordinate(origin_.z, p.z)};
}

void GeometryText::point(const Point3& place) {
  const std::array<double, 3> numbers{place.x, place.y, place.z};
  bytes(numbers.data(), sizeof numbers);
}

void GeometryText::polygon(std::size_t face) {
  const auto& rings = mesh_.faces[face].rings;
  head(Type::Polygon);
  whole(static_cast<std::uint32_t>(rings.size()));
  for (const Ring& ring : rings) {
    whole(static_cast<std::uint32_t>(ring.size() + 1));
    for (const std::uint32_t corner : ring) point(place_of(corner));
    point(place_of(ring.front()));
  }
}

void GeometryText::extend(Box3& box, std::size_t face) const {
  for (const std::uint32_t corner : mesh_.faces[face].rings.front()) box.add(place_of(corner));
}

std::string GeometryText::take() { return std::exchange(hex_, {}); }

std::string envelope_text(const Box3& box, int srid) {
  const TriangleMesh none;
  GeometryText text(none, {}, srid);
  const Point3 &a = box.min, &b = box.max;
  text.collection(GeometryText::Type::Polygon, 1);
  const std::array<Point3, 5> ring{a, Point3{b.x, a.y, a.z}, b, Point3{a.x, b.y, b.z}, a};
  text.whole(static_cast<std::uint32_t>(ring.size()));
  for (const Point3& corner : ring) text.point(corner);
  return text.take();
}

}  // namespace citymesh::citydb
