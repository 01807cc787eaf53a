#include "core/validate/body.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>

#include "core/geometry/locate.h"
#include "core/geometry/measure.h"
#include "core/validate/clashes.h"

namespace citymesh {
namespace {

using GridCorners = std::array<GridPoint, 3>;

GridCorners corners_of(const ClosedSurface& surface, std::uint32_t i) {
  const Triangle& t = surface.triangles[i];
  return {surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]};
}

/// Calls visit(i of a, j of b) for triangles whose boxes meet until it returns true; whether it
/// did.
bool any_near_pair(const ClosedSurface& a, const ClosedSurface& b,
                   const std::function<bool(std::uint32_t, std::uint32_t)>& visit) {
  if (!a.box.meets(b.box)) return false;
  std::vector<std::uint32_t> near;
  std::vector<GridBox> boxes;
  for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
    const GridBox box = box_of(a.points, a.triangles[i]);
    if (!box.meets(b.box)) continue;
    near.push_back(i);
    boxes.push_back(box);
  }
  const BoxTree tree(boxes);
  bool found = false;
  for (std::uint32_t j = 0; j < b.triangles.size() && !found; ++j) {
    const GridBox box = box_of(b.points, b.triangles[j]);
    if (!box.meets(a.box)) continue;
    tree.for_each_meeting(box, [&](std::uint32_t k) { found = found || visit(near[k], j); });
  }
  return found;
}

/// Whether segment pq goes through the inside of a triangle, from one side to the other.
bool pierces(const GridPoint& p, const GridPoint& q, const GridCorners& t) {
  if (orient3d(t[0], t[1], t[2], p) * orient3d(t[0], t[1], t[2], q) >= 0) return false;
  const int u = orient3d(p, q, t[0], t[1]), v = orient3d(p, q, t[1], t[2]),
            w = orient3d(p, q, t[2], t[0]);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

bool either_pierces(const GridCorners& s, const GridCorners& t) {
  for (std::size_t i = 0; i < 3; ++i)
    if (pierces(s[i], s[(i + 1) % 3], t) || pierces(t[i], t[(i + 1) % 3], s)) return true;
  return false;
}

/// Whether two triangles of one plane have more than a line in common.
bool overlap_in_plane(const GridCorners& s, const GridCorners& t) {
  for (const GridPoint& p : t)
    if (orient3d(s[0], s[1], s[2], p) != 0) return false;
  const Axis axis = dominant_axis(s[0], s[1], s[2]);
  std::array<GridPoint2, 3> a, b;
  for (std::size_t i = 0; i < 3; ++i) a[i] = project(s[i], axis), b[i] = project(t[i], axis);
  if (orient2d(a[0], a[1], a[2]) < 0) std::swap(a[1], a[2]);
  if (orient2d(b[0], b[1], b[2]) < 0) std::swap(b[1], b[2]);
  const auto separates = [](const auto& of, const auto& from) {
    for (std::size_t i = 0; i < 3; ++i)
      if (std::all_of(from.begin(), from.end(), [&](const GridPoint2& p) {
            return orient2d(of[i], of[(i + 1) % 3], p) <= 0;
          }))
        return true;
    return false;
  };
  return !separates(a, b) && !separates(b, a);
}

/// Whether a common place of `a` with `b` is known to lie on the wanted side: tries the corners of
/// the one, then the centres and the middles of the edges of its triangles.
bool has_sample(const ClosedSurface& of, const ClosedSurface& in, Side wanted) {
  const Locator locator(in.points, in.triangles);
  const auto is = [&](const GridPoint& place, std::int64_t parts) {
    return locator.locate(place, parts) == wanted;
  };
  const auto reaches = [&](const GridPoint& p) {
    return wanted == Side::Outside || in.box.meets(GridBox::of(p));
  };
  for (const GridPoint& p : of.points)
    if (reaches(p) && is(p, 1)) return true;
  const auto meets = [&](const Triangle& t) {
    return wanted == Side::Outside || in.box.meets(box_of(of.points, t));
  };
  for (const Triangle& t : of.triangles) {
    if (!meets(t)) continue;
    const GridPoint &a = of.points[t[0]], &b = of.points[t[1]], &c = of.points[t[2]];
    if (is({a.x + b.x + c.x, a.y + b.y + c.y, a.z + b.z + c.z}, 3)) return true;
    if (is({a.x + b.x, a.y + b.y, a.z + b.z}, 2) || is({b.x + c.x, b.y + c.y, b.z + c.z}, 2) ||
        is({c.x + a.x, c.y + a.y, c.z + a.z}, 2))
      return true;
  }
  return false;
}

/// Whether the plane of a face of `a` has all of `a` behind it and all of `b` before it.
bool face_separates(const ClosedSurface& a, const ClosedSurface& b) {
  const auto all_on = [](const ClosedSurface& surface, const GridCorners& t, int side) {
    return std::all_of(surface.points.begin(), surface.points.end(), [&](const GridPoint& p) {
      return orient3d(t[0], t[1], t[2], p) * side >= 0;
    });
  };
  for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
    const GridCorners t = corners_of(a, i);
    if (all_on(b, t, 1) && all_on(a, t, -1)) return true;
  }
  return false;
}

bool boxes_overlap(const GridBox& a, const GridBox& b) {
  return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y &&
         a.min.z < b.max.z && b.min.z < a.max.z;
}

bool surfaces_cross(const ClosedSurface& a, const ClosedSurface& b) {
  return any_near_pair(a, b, [&](std::uint32_t i, std::uint32_t j) {
    return either_pierces(corners_of(a, i), corners_of(b, j));
  });
}

/// Whether one of them has a corner inside; of surfaces that do not touch, of several pieces too.
bool any_corner_in(const ClosedSurface& of, const ClosedSurface& in) {
  const Locator locator(in.points, in.triangles);
  return std::any_of(of.points.begin(), of.points.end(), [&](const GridPoint& p) {
    return in.box.meets(GridBox::of(p)) && locator.locate(p) == Side::Inside;
  });
}

}  // namespace

bool surfaces_touch(const ClosedSurface& a, const ClosedSurface& b) {
  return any_near_pair(a, b, [&](std::uint32_t i, std::uint32_t j) {
    return triangles_meet(corners_of(a, i), corners_of(b, j));
  });
}

Answer interiors_overlap(const ClosedSurface& a, const ClosedSurface& b) {
  if (!boxes_overlap(a.box, b.box)) return Answer::No;
  if (!surfaces_touch(a, b))
    return any_corner_in(a, b) || any_corner_in(b, a) ? Answer::Yes : Answer::No;
  if (surfaces_cross(a, b) || has_sample(a, b, Side::Inside) || has_sample(b, a, Side::Inside))
    return Answer::Yes;
  if (face_separates(a, b) || face_separates(b, a)) return Answer::No;
  return Answer::Maybe;
}

Answer lies_within(const ClosedSurface& inner, const ClosedSurface& outer) {
  if (!surfaces_touch(inner, outer)) return any_corner_in(inner, outer) ? Answer::Yes : Answer::No;
  if (surfaces_cross(inner, outer) || has_sample(inner, outer, Side::Outside)) return Answer::No;
  return Answer::Maybe;
}

bool touch_or_overlap(const ClosedSurface& a, const ClosedSurface& b) {
  return surfaces_touch(a, b) || any_corner_in(a, b) || any_corner_in(b, a);
}

bool share_area(const ClosedSurface& a, const ClosedSurface& b) {
  return any_near_pair(a, b, [&](std::uint32_t i, std::uint32_t j) {
    return overlap_in_plane(corners_of(a, i), corners_of(b, j));
  });
}

Point3 common_place(const ClosedSurface& a, const ClosedSurface& b) {
  Point3 place = to_metres(a.points[a.triangles[0][0]]);
  const auto take = [&](std::uint32_t i, std::uint32_t j) {
    place = meeting_place(corners_of(a, i), corners_of(b, j));
    return true;
  };
  if (any_near_pair(a, b, [&](std::uint32_t i, std::uint32_t j) {
        return either_pierces(corners_of(a, i), corners_of(b, j)) && take(i, j);
      }))
    return place;
  any_near_pair(a, b, [&](std::uint32_t i, std::uint32_t j) {
    return triangles_meet(corners_of(a, i), corners_of(b, j)) && take(i, j);
  });
  return place;
}

}  // namespace citymesh
