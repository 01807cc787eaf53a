#include "core/reconstruct/close_chain.h"

#include <algorithm>
#include <map>

#include "core/geometry/patch.h"

namespace citymesh {
namespace {

using DirectedEdges = std::map<std::uint32_t, std::map<std::uint32_t, int>>;  // from → to → times

/// Edges to be walked, against what the facets leave over, so that all closes.
DirectedEdges open_edges(const Arrangement& arrangement) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> surplus;  // low → high
  for (std::size_t f = 0; f < arrangement.facets.size(); ++f) {
    int net = 0;
    for (const Cover& cover : arrangement.covers[f]) net += cover.along ? 1 : -1;
    if (net == 0) continue;
    const Triangle& t = arrangement.facets[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      surplus[{std::min(a, b), std::max(a, b)}] += a < b ? net : -net;
    }
  }
  DirectedEdges open;
  for (const auto& [edge, times] : surplus) {
    if (times > 0) open[edge.second][edge.first] = times;
    if (times < 0) open[edge.first][edge.second] = -times;
  }
  return open;
}

/// Takes a simple loop out of the edges; empty when none are left.
std::vector<std::uint32_t> take_loop(DirectedEdges& open) {
  std::vector<std::uint32_t> path;
  std::map<std::uint32_t, std::size_t> position;
  if (open.empty()) return path;
  std::uint32_t at = open.begin()->first;
  while (true) {
    const auto seen = position.find(at);
    if (seen != position.end()) {
      // What was walked before the loop began goes back.
      for (std::size_t i = 0; i < seen->second; ++i) ++open[path[i]][path[i + 1]];
      path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(seen->second));
      return path;
    }
    position[at] = path.size();
    path.push_back(at);
    const auto out = open.find(at);
    if (out == open.end()) return {};  // cannot be: every vertex has as many ways out as in
    const auto next = out->second.begin();
    at = next->first;
    if (--next->second == 0) out->second.erase(next);
    if (out->second.empty()) open.erase(out);
  }
}

}  // namespace

std::vector<Triangle> closing_triangles(const Arrangement& arrangement) {
  std::vector<Triangle> triangles;
  DirectedEdges open = open_edges(arrangement);
  for (auto loop = take_loop(open); !loop.empty(); loop = take_loop(open))
    if (const auto patch = minimal_patch(arrangement.points, loop))
      triangles.insert(triangles.end(), patch->begin(), patch->end());
  return triangles;
}

}  // namespace citymesh
