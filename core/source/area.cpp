#include "core/source/area.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace citymesh::source {
namespace {

// Twice the signed area of a, b, c; positive to the left.
double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool in_box_of(const Point2& a, const Point2& b, const Point2& p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool on_segment(const Point2& a, const Point2& b, const Point2& p) {
  return in_box_of(a, b, p) && turn(a, b, p) == 0;
}

bool segments_touch(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const double c_side = turn(a, b, c), d_side = turn(a, b, d);
  const double a_side = turn(c, d, a), b_side = turn(c, d, b);
  if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) &&
      ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0)))
    return true;
  return (c_side == 0 && in_box_of(a, b, c)) || (d_side == 0 && in_box_of(a, b, d)) ||
         (a_side == 0 && in_box_of(c, d, a)) || (b_side == 0 && in_box_of(c, d, b));
}

// Even-odd rule, the ring itself is inside.
bool ring_contains(std::span<const Point2> ring, const Point2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point2 &a = ring[j], &b = ring[i];
    if (on_segment(a, b, p)) return true;
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const double side = turn(a, b, p);
    if ((side > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside;
}

}  // namespace

Area::Area(std::vector<Point2> ring) : ring_(std::move(ring)) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  min_ = {kInfinity, kInfinity};
  max_ = {-kInfinity, -kInfinity};
  for (const Point2& p : ring_) {
    min_ = {std::min(min_.x, p.x), std::min(min_.y, p.y)};
    max_ = {std::max(max_.x, p.x), std::max(max_.y, p.y)};
  }
}

bool Area::contains(const Point2& point) const {
  return box_touches(point, point) && ring_contains(ring_, point);
}

bool Area::touches(std::span<const Point2> points,
                   std::span<const Footprints::Ring> polygon) const {
  const auto corners = [&](const Footprints::Ring& ring) {
    return points.subspan(ring.first, ring.count);
  };
  if (polygon.empty() || polygon.front().count == 0) return false;

  // Boundaries that meet.
  for (const Footprints::Ring& ring : polygon) {
    const auto own = corners(ring);
    for (std::size_t i = 0, j = own.size() - 1; i < own.size(); j = i++) {
      const Point2 low{std::min(own[i].x, own[j].x), std::min(own[i].y, own[j].y)};
      const Point2 high{std::max(own[i].x, own[j].x), std::max(own[i].y, own[j].y)};
      if (!box_touches(low, high)) continue;
      for (std::size_t k = 0, l = ring_.size() - 1; k < ring_.size(); l = k++)
        if (segments_touch(own[j], own[i], ring_[l], ring_[k])) return true;
    }
  }
  // Boundaries that do not: one lies in the other, or they are apart.
  if (contains(corners(polygon.front()).front())) return true;
  const Point2& p = ring_.front();
  if (!ring_contains(corners(polygon.front()), p)) return false;
  for (const Footprints::Ring& hole : polygon.subspan(1))
    if (hole.count > 0 && ring_contains(corners(hole), p)) return false;
  return true;
}

}  // namespace citymesh::source
