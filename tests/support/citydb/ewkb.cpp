#include "tests/support/citydb/ewkb.h"

#include <cstring>

namespace citymesh::citydb_support {

void Ewkb::bytes(const void* from, std::size_t count) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  const auto* const all = static_cast<const unsigned char*>(from);
  for (std::size_t i = 0; i < count; ++i) {
    hex_ += kHex[all[i] >> 4];
    hex_ += kHex[all[i] & 15];
  }
}

void Ewkb::whole(std::uint32_t value) { bytes(&value, sizeof value); }
void Ewkb::number(double value) { bytes(&value, sizeof value); }

void Ewkb::head(Type type) {
  constexpr std::uint32_t kHasZ = 0x80000000u, kHasSrid = 0x20000000u;
  const bool outermost = hex_.empty();
  hex_ += "01";  // little endian, as the machines are that this runs on
  whole(static_cast<std::uint32_t>(type) | kHasZ | (outermost && srid_ > 0 ? kHasSrid : 0u));
  if (outermost && srid_ > 0) whole(static_cast<std::uint32_t>(srid_));
}

Ewkb& Ewkb::collection(Type type, std::size_t count) {
  head(type);
  whole(static_cast<std::uint32_t>(count));
  return *this;
}

Ewkb& Ewkb::polygon(const Rings& rings) {
  head(Type::Polygon);
  whole(static_cast<std::uint32_t>(rings.size()));
  for (const auto& ring : rings) {
    whole(static_cast<std::uint32_t>(ring.size()));
    for (const Point3& point : ring) {
      number(point.x);
      number(point.y);
      number(point.z);
    }
  }
  return *this;
}

std::string envelope_ewkb(const Box3& box, int srid) {
  const Point3 &a = box.min, &b = box.max;
  return Ewkb(srid).polygon({{a, {b.x, a.y, a.z}, b, {a.x, b.y, b.z}, a}}).take();
}

}  // namespace citymesh::citydb_support
