#include "core/pipeline/signature.h"

#include <algorithm>

namespace citymesh {
namespace {

std::uint64_t mix(std::uint64_t x) {  // the finaliser of splitmix64 (Steele, Lea, Flood 2014)
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

std::uint64_t signature(std::span<const GridPoint> points, std::span<const Triangle> triangles) {
  std::uint64_t sum = 0;
  for (const Triangle& t : triangles) {
    std::array<GridPoint, 3> c{points[t[0]], points[t[1]], points[t[2]]};
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()),
                c.end());  // the cycle, not its start
    std::uint64_t h = 0;
    for (const GridPoint& p : c)
      for (const std::int64_t v : {p.x, p.y, p.z}) h = mix(h ^ static_cast<std::uint64_t>(v));
    sum += h;
  }
  return sum;
}

}  // namespace citymesh
