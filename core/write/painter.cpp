#include "core/write/painter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <span>

namespace citymesh {
namespace {

// Corners of a plane face lie this far from its plane at most, and neighbours share such corners.
constexpr double kPlaneTolerance_m = 0.02;

/// A face or a triangle with what the ordering asks of it.
struct Item {
  PaintStep step{};
  std::vector<Point3> corners{};
  Point3 normal{};
  double plane = 0;                                   // normal · x = plane
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;  // on the screen
  double near = 0, far = 0, low = 0, high = 0;        // view space y and z
  double min_depth = 0, max_depth = 0;
};

double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Item make_item(PaintStep step, std::vector<Point3> corners, const Point3& normal) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Item item{step, std::move(corners), normal};
  item.min_x = item.min_y = item.near = item.low = item.min_depth = kFar;
  item.max_x = item.max_y = item.far = item.high = item.max_depth = -kFar;
  for (const Point3& p : item.corners) {
    item.plane += dot(normal, p) / static_cast<double>(item.corners.size());
    item.min_x = std::min(item.min_x, p.x);
    item.max_x = std::max(item.max_x, p.x);
    item.min_y = std::min(item.min_y, screen_y(p));
    item.max_y = std::max(item.max_y, screen_y(p));
    item.near = std::min(item.near, p.y);
    item.far = std::max(item.far, p.y);
    item.low = std::min(item.low, p.z);
    item.high = std::max(item.high, p.z);
    item.min_depth = std::min(item.min_depth, depth(p));
    item.max_depth = std::max(item.max_depth, depth(p));
  }
  return item;
}

/// Whether all corners of `other` lie on the viewer's side (sign 1) or behind (sign -1) the plane.
bool all_on_side(const Item& plane, const Item& other, double sign) {
  return std::all_of(other.corners.begin(), other.corners.end(), [&](const Point3& p) {
    return sign * (dot(plane.normal, p) - plane.plane) >= -kPlaneTolerance_m;
  });
}

enum class Order { None, FirstBelow, SecondBelow, Unclear };

bool may_overlap(const Item& a, const Item& b) {
  // Faces that only share an edge on the screen do not hide each other.
  constexpr double kTouch_m = 1e-6;
  return a.min_x < b.max_x - kTouch_m && b.min_x < a.max_x - kTouch_m &&
         a.min_y < b.max_y - kTouch_m && b.min_y < a.max_y - kTouch_m;
}

/// Whether `a` hides nothing of `b`. What hides something is nearer, higher and on the viewer's
/// side of both planes.
bool cannot_hide(const Item& a, const Item& b) {
  return a.near >= b.far || a.high <= b.low || a.min_depth >= b.max_depth || all_on_side(a, b, 1) ||
         all_on_side(b, a, -1);
}

Order order_of(const Item& a, const Item& b) {
  if (!may_overlap(a, b)) return Order::None;
  const bool a_below = cannot_hide(a, b), b_below = cannot_hide(b, a);
  if (a_below && b_below) return Order::None;
  if (a_below) return Order::FirstBelow;
  return b_below ? Order::SecondBelow : Order::Unclear;
}

/// Depth of a triangle's plane at a place of the screen.
double depth_at(const Item& item, double x, double y) {
  // The ray through (x, y): a point with that screen place plus t · viewing direction.
  const Point3 start{x, y * kSinElevation, y * kCosElevation};
  const Point3 along{0, kCosElevation, -kSinElevation};
  const double slope = dot(item.normal, along);
  return (item.plane - dot(item.normal, start)) / slope;  // slope < 0: only visible faces are here
}

using Flat = std::array<double, 2>;

/// Cuts a convex polygon with the left side of a → b.
std::vector<Flat> cut(const std::vector<Flat>& polygon, const Flat& a, const Flat& b) {
  const auto side = [&](const Flat& p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
  };
  std::vector<Flat> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Flat &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double sp = side(p), sq = side(q);
    if (sp >= 0) kept.push_back(p);
    if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) {
      const double t = sp / (sp - sq);
      kept.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
    }
  }
  return kept;
}

/// Two triangles that the planes do not order: compares their depth in the middle of the overlap.
Order order_of_triangles(const Item& a, const Item& b) {
  const auto flat = [](const Item& item) {
    std::vector<Flat> polygon;
    for (const Point3& p : item.corners) polygon.push_back({p.x, screen_y(p)});
    return polygon;
  };
  std::vector<Flat> common = flat(a);
  const std::vector<Flat> other = flat(b);  // counter-clockwise on the screen, as all visible faces
  for (std::size_t i = 0; i < other.size() && !common.empty(); ++i)
    common = cut(common, other[i], other[(i + 1) % other.size()]);
  if (common.size() < 3) return Order::None;
  double area2 = 0, x = 0, y = 0;
  for (std::size_t i = 0; i < common.size(); ++i) {
    const Flat &p = common[i], &q = common[(i + 1) % common.size()];
    area2 += p[0] * q[1] - p[1] * q[0];
    x += p[0] / static_cast<double>(common.size());
    y += p[1] / static_cast<double>(common.size());
  }
  constexpr double kNoArea_m2 = 1e-4;
  if (area2 < kNoArea_m2) return Order::None;
  return depth_at(a, x, y) > depth_at(b, x, y) ? Order::FirstBelow : Order::SecondBelow;
}

/// Calls `pair(i, j)` once for each two items whose screen boxes overlap.
template <class Pair>
void for_each_overlap(std::span<const Item> items, const Pair& pair) {
  if (items.size() < 2) return;
  double min_x = items[0].min_x, min_y = items[0].min_y;
  double max_x = items[0].max_x, max_y = items[0].max_y;
  for (const Item& item : items) {
    min_x = std::min(min_x, item.min_x);
    max_x = std::max(max_x, item.max_x);
    min_y = std::min(min_y, item.min_y);
    max_y = std::max(max_y, item.max_y);
  }
  const double area = std::max(1e-9, (max_x - min_x) * (max_y - min_y));
  const double cell = std::sqrt(2.0 * area / static_cast<double>(items.size()));
  const auto columns = static_cast<std::size_t>((max_x - min_x) / cell) + 1;
  const auto rows = static_cast<std::size_t>((max_y - min_y) / cell) + 1;
  const auto column = [&](double x) { return static_cast<std::size_t>((x - min_x) / cell); };
  const auto row = [&](double y) { return static_cast<std::size_t>((y - min_y) / cell); };

  std::vector<std::vector<std::uint32_t>> cells(columns * rows);
  for (std::uint32_t i = 0; i < items.size(); ++i)
    for (std::size_t r = row(items[i].min_y); r <= row(items[i].max_y); ++r)
      for (std::size_t c = column(items[i].min_x); c <= column(items[i].max_x); ++c)
        cells[r * columns + c].push_back(i);

  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const auto& here = cells[r * columns + c];
      for (std::size_t i = 0; i < here.size(); ++i)
        for (std::size_t j = i + 1; j < here.size(); ++j) {
          const Item &a = items[here[i]], &b = items[here[j]];
          // Of the cells that both are in, the one with the lower left corner of the overlap
          // counts.
          if (column(std::max(a.min_x, b.min_x)) == c && row(std::max(a.min_y, b.min_y)) == r)
            pair(here[i], here[j]);
        }
    }
}

/// Which items must be painted before which.
struct Graph {
  std::vector<std::vector<std::uint32_t>> after{};
  std::vector<std::uint32_t> waiting_for{};
  std::vector<std::uint32_t> unclear{};  // whole faces that have to be split
};

Graph build_graph(std::span<const Item> items) {
  Graph graph;
  graph.after.resize(items.size());
  graph.waiting_for.resize(items.size());
  for_each_overlap(items, [&](std::uint32_t i, std::uint32_t j) {
    Order order = order_of(items[i], items[j]);
    if (order == Order::Unclear) {
      if (items[i].corners.size() == 3 && items[j].corners.size() == 3) {
        order = order_of_triangles(items[i], items[j]);
      } else {
        if (items[i].corners.size() > 3) graph.unclear.push_back(i);
        if (items[j].corners.size() > 3) graph.unclear.push_back(j);
        return;
      }
    }
    if (order == Order::FirstBelow) {
      graph.after[i].push_back(j);
      ++graph.waiting_for[j];
    } else if (order == Order::SecondBelow) {
      graph.after[j].push_back(i);
      ++graph.waiting_for[i];
    }
  });
  return graph;
}

/// Paints what waits for nothing, farthest first. Where all wait for each other the farthest goes
/// first.
std::vector<std::uint32_t> sort_items(std::span<const Item> items, Graph graph) {
  const auto farther = [&items](std::uint32_t a, std::uint32_t b) {
    if (items[a].max_depth != items[b].max_depth) return items[a].max_depth > items[b].max_depth;
    return a < b;
  };
  std::vector<std::uint32_t> by_depth(items.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) by_depth[i] = i;
  std::sort(by_depth.begin(), by_depth.end(), farther);

  const auto nearer = [&farther](std::uint32_t a, std::uint32_t b) { return farther(b, a); };
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, decltype(nearer)> ready(nearer);
  for (std::uint32_t i = 0; i < items.size(); ++i)
    if (graph.waiting_for[i] == 0) ready.push(i);

  std::vector<std::uint32_t> order;
  std::vector<char> done(items.size(), 0);
  std::size_t next_by_depth = 0;
  while (order.size() < items.size()) {
    std::uint32_t item = 0;
    if (!ready.empty()) {
      item = ready.top();
      ready.pop();
    } else {
      while (done[by_depth[next_by_depth]] != 0) ++next_by_depth;
      item = by_depth[next_by_depth];
    }
    if (done[item] != 0) continue;
    done[item] = 1;
    order.push_back(item);
    for (const std::uint32_t later : graph.after[item])
      if (--graph.waiting_for[later] == 0 && done[later] == 0) ready.push(later);
  }
  return order;
}

/// Items that lie on a cycle of the graph: what remains when all that is free at either end is
/// taken away.
std::vector<std::uint32_t> on_cycles(Graph graph) {
  const std::size_t n = graph.after.size();
  std::vector<std::vector<std::uint32_t>> before(n);
  std::vector<std::uint32_t> leads_to(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    leads_to[i] = static_cast<std::uint32_t>(graph.after[i].size());
    for (const std::uint32_t j : graph.after[i]) before[j].push_back(i);
  }
  std::vector<char> gone(n, 0);
  const auto peel = [&](std::vector<std::uint32_t>& degree,
                        const std::vector<std::vector<std::uint32_t>>& next) {
    std::vector<std::uint32_t> free;
    for (std::uint32_t i = 0; i < n; ++i)
      if (gone[i] == 0 && degree[i] == 0) free.push_back(i);
    while (!free.empty()) {
      const std::uint32_t i = free.back();
      free.pop_back();
      gone[i] = 1;
      for (const std::uint32_t j : next[i])
        if (gone[j] == 0 && --degree[j] == 0) free.push_back(j);
    }
  };
  peel(graph.waiting_for, graph.after);
  // Of the rest, take away what leads nowhere but out.
  for (std::uint32_t i = 0; i < n; ++i)
    if (gone[i] == 0) {
      leads_to[i] = 0;
      for (const std::uint32_t j : graph.after[i]) leads_to[i] += gone[j] == 0 ? 1u : 0u;
    }
  peel(leads_to, before);
  std::vector<std::uint32_t> rest;
  for (std::uint32_t i = 0; i < n; ++i)
    if (gone[i] == 0) rest.push_back(i);
  return rest;
}

}  // namespace

std::vector<PaintStep> painting_order(const std::vector<PaintFace>& faces) {
  std::vector<Item> items;
  items.reserve(faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    std::vector<Point3> corners;
    for (const auto& ring : faces[f].rings) corners.insert(corners.end(), ring.begin(), ring.end());
    if (!corners.empty()) items.push_back(make_item({f, -1}, std::move(corners), faces[f].normal));
  }

  // Splitting can make new pairs unclear, so look twice; the second look may split their
  // neighbours.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    Graph graph = build_graph(items);
    std::vector<std::uint32_t> split = graph.unclear;
    for (const std::uint32_t i : on_cycles(graph)) split.push_back(i);
    std::sort(split.begin(), split.end());
    split.erase(std::unique(split.begin(), split.end()), split.end());
    std::erase_if(split, [&](std::uint32_t i) { return items[i].step.triangle >= 0; });
    if (split.empty() || round + 1 == kRounds) {
      std::vector<PaintStep> steps;
      for (const std::uint32_t i : sort_items(items, std::move(graph)))
        steps.push_back(items[i].step);
      return steps;
    }
    std::vector<Item> next;
    std::size_t at = 0;
    for (std::uint32_t i = 0; i < items.size(); ++i) {
      if (at == split.size() || split[at] != i) {
        next.push_back(std::move(items[i]));
        continue;
      }
      ++at;
      const PaintFace& face = faces[items[i].step.face];
      for (std::size_t t = 0; t < face.triangles.size(); ++t) {
        const auto& corners = face.triangles[t];
        next.push_back(make_item({items[i].step.face, static_cast<std::int32_t>(t)},
                                 {corners.begin(), corners.end()}, face.normal));
      }
    }
    items = std::move(next);
  }
  return {};
}

}  // namespace citymesh
