#include "core/validate/shells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "core/base/union_find.h"
#include "core/geometry/measure.h"
#include "core/geometry/place.h"
#include "core/validate/clashes.h"

namespace citymesh {
namespace {

/// An edge as one triangle walks it.
struct HalfEdge {
  std::uint32_t low, high;  ///< vertices, low < high
  std::uint32_t triangle;
  bool forward;  ///< low → high
};

Point3 middle(const GridPoint& a, const GridPoint& b) {
  const Point3 p = to_metres(a), q = to_metres(b);
  return {(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
}

class ShellCheck {
 public:
  ShellCheck(const Boundary& boundary, ShellKind kind, Findings& findings)
      : boundary_(boundary), kind_(kind), findings_(findings), pieces_(boundary.polygons.size()) {}

  bool run() {
    if (kind_ == ShellKind::Closed && boundary_.polygons.size() < 4) {
      findings_.add(301, [&] { return boundary_.name + "shell"; },
                    static_cast<double>(boundary_.polygons.size()), {});
      return false;
    }
    collect_edges();
    const std::size_t before = findings_.count();
    check_edges();
    check_vertices();
    check_orientation();
    if (findings_.count() == before) check_pieces();
    if (findings_.count() == before && kind_ == ShellKind::Closed) check_holes();
    if (findings_.count() == before) report_clashes();
    return findings_.count() == before;
  }

 private:
  const GridPoint& point(std::uint32_t vertex) const { return boundary_.points[vertex]; }
  std::uint32_t polygon(const HalfEdge& edge) const { return boundary_.polygon_of[edge.triangle]; }
  std::string edge_text(const HalfEdge& edge) const {
    return place_text(point(edge.low)) + "–" + place_text(point(edge.high));
  }
  std::string label(std::uint32_t polygon) const {
    return boundary_.label(boundary_.polygons[polygon]);
  }
  Point3 centre(std::uint32_t polygon) const {
    Point3 sum{};
    const Ring& ring = boundary_.polygons[polygon].rings[0];
    for (const std::uint32_t corner : ring) {
      const Point3 p = to_metres(point(corner));
      sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
    }
    const auto n = static_cast<double>(ring.size());
    return {sum.x / n, sum.y / n, sum.z / n};
  }

  void collect_edges() {
    edges_.reserve(boundary_.triangles.size() * 3);
    for (std::uint32_t t = 0; t < boundary_.triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = boundary_.triangles[t][i], b = boundary_.triangles[t][(i + 1) % 3];
        edges_.push_back({std::min(a, b), std::max(a, b), t, a < b});
      }
    std::sort(edges_.begin(), edges_.end(), [](const HalfEdge& s, const HalfEdge& t) {
      return std::tie(s.low, s.high, s.triangle) < std::tie(t.low, t.high, t.triangle);
    });
  }

  /// Visits the uses of each edge.
  template <class Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t first = 0; first < edges_.size();) {
      std::size_t last = first + 1;
      while (last < edges_.size() && edges_[last].low == edges_[first].low &&
             edges_[last].high == edges_[first].high)
        ++last;
      visit(std::span(edges_).subspan(first, last - first));
      first = last;
    }
  }

  /// 303 at edges.
  void check_edges() {
    for_each_edge([&](std::span<const HalfEdge> uses) {
      for (std::size_t i = 1; i < uses.size(); ++i)
        pieces_.join(polygon(uses[0]), polygon(uses[i]));
      if (uses.size() > 2)
        findings_.add(
            303, [&] { return boundary_.name + "edge " + edge_text(uses[0]); },
            static_cast<double>(uses.size()), middle(point(uses[0].low), point(uses[0].high)));
    });
  }

  /// 303 at vertices: the triangles around a vertex, joined across their edges, are one fan. Fans
  /// that are open may lie side by side in a shell with holes, but not in a surface.
  void check_vertices() {
    const auto corner = [&](std::uint32_t triangle, std::uint32_t vertex) {
      const Triangle& t = boundary_.triangles[triangle];
      return triangle * 3 + (t[0] == vertex ? 0u : t[1] == vertex ? 1u : 2u);
    };
    UnionFind fans(boundary_.triangles.size() * 3);
    std::vector<std::uint32_t> open_corners;
    for_each_edge([&](std::span<const HalfEdge> uses) {
      for (const std::uint32_t vertex : {uses[0].low, uses[0].high}) {
        for (std::size_t i = 1; i < uses.size(); ++i)
          fans.join(corner(uses[0].triangle, vertex), corner(uses[i].triangle, vertex));
        if (uses.size() == 1) open_corners.push_back(corner(uses[0].triangle, vertex));
      }
    });
    std::vector<bool> open(boundary_.triangles.size() * 3, false);
    for (const std::uint32_t c : open_corners) open[fans.root(c)] = true;
    struct Around {
      std::uint32_t fans = 0, closed = 0;
    };
    std::vector<Around> around(boundary_.points.size());
    for (std::uint32_t c = 0; c < open.size(); ++c) {
      if (fans.root(c) != c) continue;
      Around& vertex = around[boundary_.triangles[c / 3][c % 3]];
      ++vertex.fans;
      if (!open[c]) ++vertex.closed;
    }
    for (std::uint32_t v = 0; v < around.size(); ++v)
      if (around[v].fans > 1 && (around[v].closed > 0 || kind_ == ShellKind::Surface))
        findings_.add(
            303, [&] { return boundary_.name + "vertex " + place_text(point(v)); },
            static_cast<double>(around[v].fans), to_metres(point(v)));
  }

  /// 307: of the polygons that hang together the fewer ones that look the other way.
  void check_orientation() {
    struct Neighbour {
      std::uint32_t polygon;
      bool agrees;
    };
    std::vector<std::vector<Neighbour>> neighbours(boundary_.polygons.size());
    bool clash = false;
    for_each_edge([&](std::span<const HalfEdge> uses) {
      if (uses.size() != 2 || polygon(uses[0]) == polygon(uses[1])) return;
      const bool agrees = uses[0].forward != uses[1].forward;
      clash = clash || !agrees;
      neighbours[polygon(uses[0])].push_back({polygon(uses[1]), agrees});
      neighbours[polygon(uses[1])].push_back({polygon(uses[0]), agrees});
    });
    if (!clash) return;
    constexpr signed char kNew = -1;
    std::vector<signed char> turned(boundary_.polygons.size(), kNew);
    for (std::uint32_t start = 0; start < turned.size(); ++start) {
      if (turned[start] != kNew) continue;
      std::vector<std::uint32_t> piece{start};
      turned[start] = 0;
      bool one_sided = false;
      for (std::size_t i = 0; i < piece.size(); ++i)
        for (const Neighbour& next : neighbours[piece[i]]) {
          const auto wanted = static_cast<signed char>(turned[piece[i]] ^ (next.agrees ? 0 : 1));
          if (turned[next.polygon] == kNew) {
            turned[next.polygon] = wanted;
            piece.push_back(next.polygon);
          } else {
            one_sided = one_sided || turned[next.polygon] != wanted;
          }
        }
      const auto others = std::count_if(piece.begin(), piece.end(),
                                        [&](std::uint32_t p) { return turned[p] == 1; });
      const bool minority = others * 2 <= static_cast<std::ptrdiff_t>(piece.size());
      std::sort(piece.begin(), piece.end());
      if (one_sided) {
        findings_.add(
            307, [&] { return label(piece[0]) + ": the surface has only one side"; },
            static_cast<double>(piece.size()), centre(piece[0]));
        continue;
      }
      for (const std::uint32_t p : piece)
        if ((turned[p] == 1) == minority)
          if (others > 0)
            findings_.add(
                307, [&] { return label(p); }, 0, centre(p));
    }
  }

  /// 305: every piece besides the largest one.
  void check_pieces() {
    std::map<std::uint32_t, std::size_t> sizes;
    for (std::uint32_t p = 0; p < boundary_.polygons.size(); ++p) ++sizes[pieces_.root(p)];
    if (sizes.size() < 2) return;
    const auto largest =
        std::max_element(sizes.begin(), sizes.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    for (auto piece = sizes.begin(); piece != sizes.end(); ++piece)
      if (piece != largest)
        findings_.add(
            305, [&] { return "piece with " + label(piece->first); },
            static_cast<double>(piece->second), centre(piece->first));
  }

  /// 302: every hole, as the open edges that hang together.
  void check_holes() {
    std::vector<HalfEdge> open;
    UnionFind vertices(boundary_.points.size());
    for_each_edge([&](std::span<const HalfEdge> uses) {
      if (uses.size() != 1) return;
      open.push_back(uses[0]);
      vertices.join(uses[0].low, uses[0].high);
    });
    if (open.empty()) return;
    struct Hole {
      std::size_t first = 0, edges = 0;
    };
    std::map<std::uint32_t, Hole> holes;
    for (std::size_t i = 0; i < open.size(); ++i) {
      Hole& hole = holes[vertices.root(open[i].low)];
      if (hole.edges++ == 0) hole.first = i;
    }
    const std::vector<std::uint32_t> on = vertices_on(open);
    for (const auto& [root, hole] : holes) {
      const HalfEdge& edge = open[hole.first];
      findings_.add(
          302,
          [&, root = root] {
            std::string where = fmt::format("{}edge {} of {}", boundary_.name, edge_text(edge),
                                            label(polygon(edge)));
            for (std::size_t i = 0; i < open.size(); ++i)
              if (on[i] != kNone && vertices.root(open[i].low) == root) {
                where += fmt::format(", vertex {} lies on an edge", place_text(point(on[i])));
                break;
              }
            return where;
          },
          static_cast<double>(hole.edges), middle(point(edge.low), point(edge.high)));
    }
  }

  /// For every open edge a vertex of another one that lies on it within a millimetre: a T-junction,
  /// which is why the shell is open.
  std::vector<std::uint32_t> vertices_on(const std::vector<HalfEdge>& open) const {
    constexpr double kReach_m = 0.001;
    constexpr auto kReach = static_cast<std::int64_t>(kReach_m * kGridStepsPerMetre);
    std::vector<GridBox> boxes;
    for (const HalfEdge& edge : open) {
      boxes.push_back(GridBox::of(point(edge.low)));
      boxes.back().add(point(edge.high));
    }
    const BoxTree tree(boxes);
    std::vector<std::uint32_t> on(open.size(), kNone);
    for (const HalfEdge& edge : open)
      for (const std::uint32_t vertex : {edge.low, edge.high})
        tree.for_each_meeting(GridBox::of(point(vertex)).grown(kReach), [&](std::uint32_t i) {
          if (open[i].low == vertex || open[i].high == vertex || on[i] <= vertex) return;
          double position = 0;
          if (distance_to_segment_m(point(vertex), point(open[i].low), point(open[i].high),
                                    &position) < kReach_m &&
              position > 0 && position < 1)
            on[i] = vertex;
        });
    return on;
  }

  /// 306: every pair of polygons that meet where they should not.
  void report_clashes() {
    for (const Clash& clash : find_clashes(boundary_))
      findings_.add(
          306,
          [&] {
            const std::string first = label(clash.polygon);
            return clash.polygon == clash.other
                       ? first + " with itself"
                       : fmt::format("{} with {}", first,
                                     boundary_.label(boundary_.polygons[clash.other]));
          },
          0, clash.at);
  }

  static constexpr std::uint32_t kNone = ~0u;

  const Boundary& boundary_;
  ShellKind kind_;
  Findings& findings_;
  std::vector<HalfEdge> edges_;
  UnionFind pieces_;
};

}  // namespace

bool check_shell_level(const Boundary& boundary, ShellKind kind, Findings& findings) {
  return ShellCheck(boundary, kind, findings).run();
}

}  // namespace citymesh
