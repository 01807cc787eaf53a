#include "core/validate/neighbours.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/locate.h"
#include "core/geometry/measure.h"

namespace citymesh {
namespace {

constexpr std::int64_t kSquare = 640'000;  ///< steps: 64 m
constexpr std::int64_t kMaxSquares = 256;  ///< of one building

std::int64_t square_of(std::int64_t c) {
  return c >= 0 ? c / kSquare : -((-c + kSquare - 1) / kSquare);
}

struct Squares {
  std::int64_t x0, y0, x1, y1;
  explicit Squares(const GridBox& box)
      : x0(square_of(box.min.x)),
        y0(square_of(box.min.y)),
        x1(square_of(box.max.x)),
        y1(square_of(box.max.y)) {}
  bool few() const { return (x1 - x0 + 1) * (y1 - y0 + 1) <= kMaxSquares; }
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::int64_t x = x0; x <= x1; ++x)
      for (std::int64_t y = y0; y <= y1; ++y)
        visit((static_cast<std::uint64_t>(x) << 32) ^ static_cast<std::uint32_t>(y));
  }
};

std::int64_t steps(double metres) {
  return static_cast<std::int64_t>(std::ceil(metres * kGridStepsPerMetre));
}

double length(const Point3& n) { return std::hypot(n.x, n.y, n.z); }
double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point3 minus(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// How deep corners of one solid lie in another, at most.
double depth_m(const ClosedSurface& of, const ClosedSurface& in) {
  double deepest = 0;
  std::optional<DistanceField> field;
  const Locator locator(in.points, in.triangles);
  for (const GridPoint& p : of.points) {
    if (!in.box.meets(GridBox::of(p)) || locator.locate(p) != Side::Inside) continue;
    if (!field) field.emplace(in.points, in.triangles);
    deepest = std::max(deepest, field->distance_m(p));
  }
  return deepest;
}

/// Where two triangles stand face to face.
struct Facing {
  double distance_m = 0;  ///< the least one
  double area_m2 = 0;     ///< that they have in common, seen along the first one's normal
  Point3 at{};
};

using LocalCorners = std::array<Point3, 3>;

/// What of triangle t stands in front of s and faces it; the angle between them is at most a few
/// degrees. Metres from the first corner of s.
std::optional<Facing> facing(const LocalCorners& s, const LocalCorners& t) {
  const auto normal = [](const LocalCorners& c) {
    const Point3 a = minus(c[1], c[0]), b = minus(c[2], c[0]);
    return Point3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  constexpr double kMinCosine = 0.996;  // 5 degrees
  const Point3 ns = normal(s), nt = normal(t);
  const double ls = length(ns), lt = length(nt);
  if (ls == 0 || lt == 0 || dot(ns, nt) > -kMinCosine * ls * lt) return {};
  const Point3 n{ns.x / ls, ns.y / ls, ns.z / ls};

  // t cut by the planes that stand on the edges of s (Sutherland and Hodgman 1974).
  std::vector<Point3> piece(t.begin(), t.end()), cut;
  for (std::size_t i = 0; i < 3 && !piece.empty(); ++i) {
    const Point3 edge = minus(s[(i + 1) % 3], s[i]);
    const Point3 inward{n.y * edge.z - n.z * edge.y, n.z * edge.x - n.x * edge.z,
                        n.x * edge.y - n.y * edge.x};
    cut.clear();
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const Point3 &p = piece[k], &q = piece[(k + 1) % piece.size()];
      const double dp = dot(inward, minus(p, s[i])), dq = dot(inward, minus(q, s[i]));
      if (dp >= 0) cut.push_back(p);
      if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
        const double u = dp / (dp - dq);
        cut.push_back({p.x + u * (q.x - p.x), p.y + u * (q.y - p.y), p.z + u * (q.z - p.z)});
      }
    }
    piece.swap(cut);
  }
  if (piece.size() < 3) return {};
  Facing found;
  found.distance_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < piece.size(); ++k) {
    if (k >= 2) found.area_m2 += length(normal({piece[0], piece[k - 1], piece[k]})) / 2;
    const double d = dot(n, minus(piece[k], s[0]));
    found.distance_m = std::min(found.distance_m, d);
    const auto count = static_cast<double>(piece.size());
    found.at = {found.at.x + piece[k].x / count, found.at.y + piece[k].y / count,
                found.at.z + piece[k].z / count};
  }
  return found;
}

/// The narrowest place between two buildings and how much of their faces stands so close.
struct Narrow {
  double least_m = std::numeric_limits<double>::infinity();
  double area_m2 = 0;
  Point3 at{};

  void add(const Facing& facing, const Point3& at_origin) {
    area_m2 += facing.area_m2;
    if (facing.distance_m >= least_m) return;
    least_m = facing.distance_m;
    at = {facing.at.x + at_origin.x, facing.at.y + at_origin.y, facing.at.z + at_origin.z};
  }
};

template <class Visit>
void for_each_facing(const ClosedSurface& a, const ClosedSurface& b, double reach_m,
                     Visit&& visit) {
  const std::int64_t reach = steps(reach_m);
  std::vector<std::uint32_t> near;
  std::vector<GridBox> boxes;
  for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
    const GridBox box = box_of(a.points, a.triangles[i]).grown(reach);
    if (!box.meets(b.box)) continue;
    near.push_back(i);
    boxes.push_back(box);
  }
  const BoxTree tree(boxes);
  for (const Triangle& other : b.triangles) {
    const GridBox box = box_of(b.points, other);
    tree.for_each_meeting(box, [&](std::uint32_t k) {
      const Triangle& triangle = a.triangles[near[k]];
      const GridPoint& base = a.points[triangle[0]];
      const auto local = [&](const GridPoint& p) {
        return to_metres({p.x - base.x, p.y - base.y, p.z - base.z});
      };
      LocalCorners s, t;
      for (std::size_t i = 0; i < 3; ++i) {
        s[i] = local(a.points[triangle[i]]);
        t[i] = local(b.points[other[i]]);
      }
      if (const auto found = facing(s, t)) visit(*found, to_metres(base));
    });
  }
}

}  // namespace

void Neighbours::add(std::string gml_id, std::vector<SolidBody> solids) {
  Kept kept;
  kept.gml_id = std::move(gml_id);
  for (const SolidBody& solid : solids) {
    triangles_ += solid.exterior.triangles.size();
    if (&solid == solids.data()) kept.box = solid.exterior.box;
    kept.box.add(solid.exterior.box);
  }
  if (!complete()) {
    for (Kept& building : buildings_) building.solids = {};
    squares_.clear();
    wide_.clear();
    solids.clear();
  }
  kept.solids = std::move(solids);
  const auto number = static_cast<std::uint32_t>(buildings_.size());
  if (!kept.solids.empty()) {
    const Squares squares(kept.box);
    if (squares.few())
      squares.for_each([&](std::uint64_t key) { squares_[key].push_back(number); });
    else
      wide_.push_back(number);
  }
  buildings_.push_back(std::move(kept));
}

std::vector<std::uint32_t> Neighbours::near(std::size_t number) const {
  const GridBox box = buildings_[number].box.grown(steps(options_.gap_threshold_m));
  std::vector<std::uint32_t> found;
  const auto take = [&](std::uint32_t other) {
    if (other < number && box.meets(buildings_[other].box)) found.push_back(other);
  };
  const Squares squares(box);
  if (squares.few()) {
    squares.for_each([&](std::uint64_t key) {
      if (const auto square = squares_.find(key); square != squares_.end())
        std::for_each(square->second.begin(), square->second.end(), take);
    });
    std::for_each(wide_.begin(), wide_.end(), take);
  } else {
    for (std::uint32_t other = 0; other < number; ++other)
      if (!buildings_[other].solids.empty()) take(other);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<Issue> Neighbours::issues_of(std::size_t number) const {
  std::vector<Issue> issues;
  const Kept& building = buildings_[number];
  if (building.solids.empty()) return issues;
  for (const std::uint32_t other : near(number)) compare(building, buildings_[other], issues);
  return issues;
}

void Neighbours::compare(const Kept& building, const Kept& other,
                         std::vector<Issue>& issues) const {
  Narrow wall, gap;
  std::optional<Issue> overlap;
  for (const SolidBody& mine : building.solids)
    for (const SolidBody& theirs : other.solids) {
      const ClosedSurface &a = mine.exterior, &b = theirs.exterior;
      if (!a.box.grown(steps(options_.gap_threshold_m)).meets(b.box)) continue;
      if (interiors_overlap(a, b) == Answer::Yes) {
        const double depth = std::max(depth_m(a, b), depth_m(b, a));
        if (!overlap || depth > overlap->measured)
          overlap = Issue{issue_code::kBuildingsOverlap, other.gml_id, depth, common_place(a, b)};
        continue;
      }
      for_each_facing(
          a, b, options_.gap_threshold_m, [&](const Facing& found, const Point3& origin) {
            constexpr double kMinArea_m2 = 0.01;
            if (found.area_m2 < kMinArea_m2 || found.distance_m < kGridStep_m / 2 ||
                found.distance_m >= options_.gap_threshold_m)
              return;
            (found.distance_m <= options_.wall_tolerance_m ? wall : gap).add(found, origin);
          });
    }
  if (overlap) issues.push_back(*overlap);
  const auto report = [&](int code, const Narrow& narrow) {
    if (narrow.area_m2 > 0)
      issues.push_back({code, fmt::format("{} ({:.2f} m²)", other.gml_id, narrow.area_m2),
                        narrow.least_m, narrow.at});
  };
  report(issue_code::kNearDuplicateWall, wall);
  report(issue_code::kNarrowGap, gap);
}

}  // namespace citymesh
