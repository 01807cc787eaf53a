#include "core/source/area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace citymesh::source {
namespace {

constexpr double kRounding = 1e-9;  // of the area's size

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

// Where the foot of p lies on a, b: 0 at a, 1 at b. NaN when those are one point.
double along(const Point2& a, const Point2& b, const Point2& p) {
  const double x = b.x - a.x, y = b.y - a.y;
  return ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
}

double distance_to_segment(const Point2& a, const Point2& b, const Point2& p) {
  const double t = a == b ? 0 : std::clamp(along(a, b, p), 0.0, 1.0);
  return std::hypot(a.x + (b.x - a.x) * t - p.x, a.y + (b.y - a.y) * t - p.y);
}

enum class Place { Outside, Boundary, Inside };

// By the even-odd rule.
Place place_in(std::span<const Point2> ring, const Point2& p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point2 &a = ring[j], &b = ring[i];
    if (on_segment(a, b, p)) return Place::Boundary;
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const double side = turn(a, b, p);
    if ((side > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside ? Place::Inside : Place::Outside;
}

bool ring_contains(std::span<const Point2> ring, const Point2& p) {
  return place_in(ring, p) != Place::Outside;
}

// Calls `visit` with both ends of every side; ends with true when that gives true.
template <class Visit>
bool any_side(std::span<const Point2> ring, Visit visit) {
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    if (visit(ring[j], ring[i])) return true;
  return false;
}

}  // namespace

Area::Area(std::vector<Ring2> rings) : rings_(std::move(rings)) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  min_ = {kInfinity, kInfinity};
  max_ = {-kInfinity, -kInfinity};
  for (const Ring2& ring : rings_)
    for (const Point2& p : ring) {
      min_ = {std::min(min_.x, p.x), std::min(min_.y, p.y)};
      max_ = {std::max(max_.x, p.x), std::max(max_.y, p.y)};
    }
}

bool Area::contains(const Point2& point) const {
  if (!box_touches(point, point)) return false;
  bool inside = false;
  for (const Ring2& ring : rings_) {
    const Place place = place_in(ring, point);
    if (place == Place::Boundary) return true;
    if (place == Place::Inside) inside = !inside;
  }
  return inside;
}

bool Area::contains_sides(std::span<const Point2> ring) const {
  const double rounding = kRounding * std::max(max_.x - min_.x, max_.y - min_.y);
  const auto on_boundary = [&](const Point2& p) {
    return std::any_of(rings_.begin(), rings_.end(), [&](const Ring2& own) {
      return any_side(own, [&](const Point2& c, const Point2& d) {
        return distance_to_segment(c, d, p) <= rounding;
      });
    });
  };
  for (const Point2& point : ring)
    if (!contains(point) && !on_boundary(point)) return false;
  // Between its ends a side can only leave through a side or a corner of the area: each piece of it
  // is inside with its middle.
  return !any_side(ring, [&](const Point2& a, const Point2& b) {
    std::vector<double> cuts{0, 1};
    for (const Ring2& own : rings_)
      any_side(own, [&](const Point2& c, const Point2& d) {
        const double c_side = turn(a, b, c), d_side = turn(a, b, d);
        if (c_side != d_side && std::min(c_side, d_side) <= 0 && std::max(c_side, d_side) >= 0) {
          const double s = c_side / (c_side - d_side);
          cuts.push_back(along(a, b, {c.x + (d.x - c.x) * s, c.y + (d.y - c.y) * s}));
        }
        return false;
      });
    std::erase_if(cuts, [](double t) { return !(t >= 0 && t <= 1); });
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      const double t = (cuts[i - 1] + cuts[i]) / 2;
      const Point2 middle{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
      if (!contains(middle) && !on_boundary(middle)) return true;
    }
    return false;
  });
}

bool Area::touches(std::span<const Point2> points,
                   std::span<const Footprints::Ring> polygon) const {
  const auto corners = [&](const Footprints::Ring& ring) {
    return points.subspan(ring.first, ring.count);
  };
  if (polygon.empty() || polygon.front().count == 0) return false;

  // Boundaries that meet.
  for (const Footprints::Ring& ring : polygon) {
    const bool meets = any_side(corners(ring), [&](const Point2& a, const Point2& b) {
      const Point2 low{std::min(a.x, b.x), std::min(a.y, b.y)};
      const Point2 high{std::max(a.x, b.x), std::max(a.y, b.y)};
      return box_touches(low, high) &&
             std::any_of(rings_.begin(), rings_.end(), [&](const Ring2& own) {
               return any_side(own, [&](const Point2& c, const Point2& d) {
                 return segments_touch(a, b, c, d);
               });
             });
    });
    if (meets) return true;
  }
  // Boundaries that do not: one lies in the other, or they are apart.
  if (contains(corners(polygon.front()).front())) return true;
  return std::any_of(rings_.begin(), rings_.end(), [&](const Ring2& own) {
    const Point2& p = own.front();
    if (!ring_contains(corners(polygon.front()), p)) return false;
    for (const Footprints::Ring& hole : polygon.subspan(1))
      if (hole.count > 0 && ring_contains(corners(hole), p)) return false;
    return true;
  });
}

}  // namespace citymesh::source
