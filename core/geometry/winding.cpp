#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/union_find.h"
#include "core/geometry/around_edge.h"
#include "core/geometry/cells.h"
#include "core/geometry/predicates.h"

namespace citymesh {
namespace {

// A facet f has two sides: 2f, its front, and 2f + 1, its back. Sides that see each other around an
// edge belong to one cell.

double net_weight(const std::vector<Cover>& covers, std::span<const std::int8_t> weights) {
  double net = 0;
  for (const Cover& cover : covers)
    net += cover.along ? weights[cover.input] : -weights[cover.input];
  return net;
}

/// Winding number on one side of a facet: signed crossings of the ray from its centre in direction
/// (1, ε, ε²), symbolically perturbed. Exact when the weights close up.
class Ray {
 public:
  Ray(const Arrangement& arrangement, std::span<const double> net)
      : arrangement_(arrangement), net_(net) {}

  struct Start {
    bool front;  ///< the side on which the ray leaves
    double winding;
  };

  Start from(std::uint32_t facet) const {
    const Triangle& t = arrangement_.facets[facet];
    const GridPoint &a = point(t[0]), &b = point(t[1]), &c = point(t[2]);
    const GridPoint centre{a.x + b.x + c.x, a.y + b.y + c.y, a.z + b.z + c.z};  // times three
    double winding = 0;
    for (std::uint32_t f = 0; f < arrangement_.facets.size(); ++f)
      if (f != facet && net_[f] != 0) winding += net_[f] * crossing(f, centre);
    return {facing(t) > 0, winding};
  }

 private:
  const GridPoint& point(std::uint32_t i) const { return arrangement_.points[i]; }
  GridPoint tripled(std::uint32_t i) const {
    const GridPoint& p = point(i);
    return {3 * p.x, 3 * p.y, 3 * p.z};
  }

  /// Sign of the normal along the ray.
  int facing(const Triangle& t) const {
    for (const Axis axis : {Axis::X, Axis::Y, Axis::Z})
      if (const int s = orient2d(project(point(t[0]), axis), project(point(t[1]), axis),
                                 project(point(t[2]), axis));
          s != 0)
        return s;
    return 0;
  }

  /// +1 where the ray leaves through the front, -1 where it enters, 0 where it misses.
  int crossing(std::uint32_t f, const GridPoint& from) const {
    const Triangle& t = arrangement_.facets[f];
    const GridPoint p[3] = {tripled(t[0]), tripled(t[1]), tripled(t[2])};
    if (std::max({p[0].x, p[1].x, p[2].x}) < from.x) return 0;
    const GridPoint2 o = project(from, Axis::X),
                     q[3] = {project(p[0], Axis::X), project(p[1], Axis::X),
                             project(p[2], Axis::X)};
    bool hit = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const GridPoint2 &u = q[i], &v = q[(i + 1) % 3];
      if ((u.y > o.y) == (v.y > o.y)) continue;
      const int side = orient2d(u, v, o);
      if (side != 0 && (side > 0) == (v.y > u.y)) hit = !hit;
    }
    if (!hit) return 0;
    const int towards = orient2d(q[0], q[1], q[2]);
    const int side = orient3d(p[0], p[1], p[2], from);
    return towards != 0 && side * towards < 0 ? towards : 0;
  }

  const Arrangement& arrangement_;
  std::span<const double> net_;
};

/// Solid angle of a triangle seen from a place, over 4π (van Oosterom and Strackee 1983).
double solid_angle(const Point3& a, const Point3& b, const Point3& c) {
  const auto dot = [](const Point3& u, const Point3& v) {
    return u.x * v.x + u.y * v.y + u.z * v.z;
  };
  const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
  const double volume =
      a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  return std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb) /
         (2 * std::numbers::pi);
}

class Count {
 public:
  Count(const Arrangement& arrangement, const std::vector<std::uint32_t>& cell_of_side,
        const std::vector<std::vector<std::uint32_t>>& facets_of_cell,
        const std::vector<std::uint32_t>& set_of_facet, std::span<const std::int8_t> weights)
      : arrangement_(arrangement),
        cell_of_side_(cell_of_side),
        facets_of_cell_(facets_of_cell),
        set_of_facet_(set_of_facet),
        of_cell_(facets_of_cell.size()) {
    net_.reserve(arrangement.facets.size());
    for (const auto& covers : arrangement.covers) net_.push_back(net_weight(covers, weights));
  }

  WindingNumbers numbers() {
    WindingNumbers result;
    result.exact = count_crossings();
    if (!result.exact) measure_angles();
    for (std::size_t f = 0; f < net_.size(); ++f) {
      result.front.push_back(of_cell_[cell_of_side_[2 * f]]);
      result.back.push_back(of_cell_[cell_of_side_[2 * f + 1]]);
    }
    return result;
  }

 private:
  /// From one ray per connected set of facets to all its cells; false when they do not agree.
  bool count_crossings() {
    const auto count = static_cast<std::uint32_t>(net_.size());
    const Ray ray(arrangement_, net_);
    std::vector<char> seen(count, 0), known(of_cell_.size(), 0);
    for (std::uint32_t seed = 0; seed < count; ++seed) {
      if (seen[set_of_facet_[seed]]) continue;
      seen[set_of_facet_[seed]] = 1;
      const Ray::Start start = ray.from(seed);
      std::vector<std::uint32_t> stack{cell_of_side_[2 * seed + (start.front ? 0u : 1u)]};
      of_cell_[stack[0]] = start.winding;
      known[stack[0]] = 1;
      while (!stack.empty()) {
        const std::uint32_t cell = stack.back();
        stack.pop_back();
        for (const std::uint32_t f : facets_of_cell_[cell]) {
          const std::uint32_t front = cell_of_side_[2 * f], back = cell_of_side_[2 * f + 1];
          if (front == back) {
            if (net_[f] != 0) return false;
            continue;
          }
          const std::uint32_t other = cell == front ? back : front;
          const double winding = of_cell_[cell] + (cell == front ? net_[f] : -net_[f]);
          if (known[other]) {
            if (of_cell_[other] != winding) return false;
            continue;
          }
          known[other] = 1;
          of_cell_[other] = winding;
          stack.push_back(other);
        }
      }
    }
    return true;
  }

  /// Means of the generalised winding number just off the largest facets of each cell.
  void measure_angles() {
    constexpr std::size_t kSamplesPerCell = 24;
    constexpr double kOffset = 20;  // steps: 2 mm off the facet
    struct Sample {
      double area;
      std::uint32_t side;
    };
    std::vector<std::vector<Sample>> samples(of_cell_.size());
    for (std::uint32_t f = 0; f < net_.size(); ++f) {
      const Triangle& t = arrangement_.facets[f];
      const Point3 n = normal_of(point(t[0]), point(t[1]), point(t[2]));
      const double area = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
      for (const std::uint32_t side : {2 * f, 2 * f + 1})
        samples[cell_of_side_[side]].push_back({area, side});
    }
    for (std::size_t cell = 0; cell < samples.size(); ++cell) {
      std::vector<Sample>& all = samples[cell];
      std::sort(all.begin(), all.end(), [](const Sample& s, const Sample& t) {
        return s.area != t.area ? s.area > t.area : s.side < t.side;
      });
      if (all.size() > kSamplesPerCell) all.resize(kSamplesPerCell);
      double sum = 0, weight = 0;
      for (const Sample& sample : all) {
        sum += sample.area * generalised(sample.side, sample.area, kOffset);
        weight += sample.area;
      }
      of_cell_[cell] = sum / weight;
    }
  }

  double generalised(std::uint32_t side, double normal_length, double offset) const {
    const Triangle& t = arrangement_.facets[side / 2];
    const GridPoint &a = point(t[0]), &b = point(t[1]), &c = point(t[2]);
    const Point3 n = normal_of(a, b, c);
    const double along = (side % 2 == 0 ? offset : -offset) / normal_length;
    const Point3 from{static_cast<double>(a.x + b.x + c.x) / 3 + n.x * along,
                      static_cast<double>(a.y + b.y + c.y) / 3 + n.y * along,
                      static_cast<double>(a.z + b.z + c.z) / 3 + n.z * along};
    const auto seen = [&](std::uint32_t i) {
      const GridPoint& p = point(i);
      return Point3{static_cast<double>(p.x) - from.x, static_cast<double>(p.y) - from.y,
                    static_cast<double>(p.z) - from.z};
    };
    double winding = 0;
    for (std::size_t f = 0; f < net_.size(); ++f) {
      if (net_[f] == 0) continue;
      const Triangle& u = arrangement_.facets[f];
      winding += net_[f] * solid_angle(seen(u[0]), seen(u[1]), seen(u[2]));
    }
    return winding;
  }

  const GridPoint& point(std::uint32_t i) const { return arrangement_.points[i]; }

  const Arrangement& arrangement_;
  const std::vector<std::uint32_t>& cell_of_side_;
  const std::vector<std::vector<std::uint32_t>>& facets_of_cell_;
  const std::vector<std::uint32_t>& set_of_facet_;
  std::vector<double> net_;  ///< weight of each facet along its own orientation
  std::vector<double> of_cell_;
};

}  // namespace

Cells::Cells(const Arrangement& arrangement) : arrangement_(arrangement) {
  const auto count = static_cast<std::uint32_t>(arrangement.facets.size());
  UnionFind sides(2 * std::size_t{count}), facets(count);
  for (auto& [edge, fan] : edge_fans(arrangement.facets)) {
    sort_around(arrangement.points, edge.first, edge.second, fan);
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const EdgeFacet &s = fan[i], &t = fan[(i + 1) % fan.size()];
      sides.join(2 * s.facet + (s.forward ? 0u : 1u), 2 * t.facet + (t.forward ? 1u : 0u));
      facets.join(s.facet, t.facet);
    }
  }
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> cell_of_root(2 * std::size_t{count}, kNone);
  for (std::uint32_t side = 0; side < 2 * count; ++side) {
    std::uint32_t& cell = cell_of_root[sides.root(side)];
    if (cell == kNone) {
      cell = static_cast<std::uint32_t>(facets_of_cell_.size());
      facets_of_cell_.emplace_back();
    }
    cell_of_side_.push_back(cell);
    facets_of_cell_[cell].push_back(side / 2);
  }
  for (std::uint32_t f = 0; f < count; ++f) set_of_facet_.push_back(facets.root(f));
}

WindingNumbers Cells::winding(std::span<const std::int8_t> weights) const {
  return Count(arrangement_, cell_of_side_, facets_of_cell_, set_of_facet_, weights).numbers();
}

WindingNumbers winding_numbers(const Arrangement& arrangement,
                               std::span<const std::int8_t> weights) {
  return Cells(arrangement).winding(weights);
}

}  // namespace citymesh
