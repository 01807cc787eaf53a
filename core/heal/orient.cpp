#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/citymodel/edges.h"
#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"

namespace citymesh {
namespace {

void turn(Face& face) {
  for (Ring& ring : face.rings) std::reverse(ring.begin(), ring.end());
}

/// Volume between a face and the origin of `base`, by fans of its rings; right also for faces with
/// holes.
double volume_under(const Shell& shell, const Face& face, const GridPoint& base) {
  double volume = 0;
  for (const Ring& ring : face.rings)
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      volume += static_cast<double>(
          volume6(shell.points[ring[0]], shell.points[ring[i + 1]], shell.points[ring[i]], base));
  return volume;
}

}  // namespace

void orient_faces(Shell& shell, StepContext& context) {
  // Holes run against their exterior.
  for (Face& face : shell.faces) {
    const Point3 n = ring_normal(shell.points, face.rings[0]);
    for (std::size_t r = 1; r < face.rings.size(); ++r) {
      const Point3 h = ring_normal(shell.points, face.rings[r]);
      if (n.x * h.x + n.y * h.y + n.z * h.z > 0)
        std::reverse(face.rings[r].begin(), face.rings[r].end());
    }
  }

  struct Link {
    std::uint32_t face;
    bool turned;  ///< the two faces walk their edge in the same direction
  };
  std::vector<std::vector<Link>> links(shell.faces.size());
  for (const auto& [edge, uses] : EdgeUses(shell)) {
    if (uses.size() != 2 || uses[0].face == uses[1].face) continue;
    const bool turned = uses[0].forward == uses[1].forward;
    links[uses[0].face].push_back({uses[1].face, turned});
    links[uses[1].face].push_back({uses[0].face, turned});
  }

  enum : char { kUnseen, kKeep, kTurn };
  std::vector<char> state(shell.faces.size(), kUnseen);
  for (std::uint32_t seed = 0; seed < shell.faces.size(); ++seed) {
    if (state[seed] != kUnseen) continue;
    std::vector<std::uint32_t> component{seed};
    state[seed] = kKeep;
    for (std::size_t i = 0; i < component.size(); ++i)
      for (const Link& link : links[component[i]])
        if (state[link.face] == kUnseen) {
          state[link.face] = (state[component[i]] == kKeep) != link.turned ? kKeep : kTurn;
          component.push_back(link.face);
        }
    // Seen from the lowest corner a missing ground, the commonest gap, adds nothing to the volume.
    GridPoint base = shell.points[shell.faces[seed].rings[0][0]];
    for (const std::uint32_t f : component)
      for (const std::uint32_t corner : shell.faces[f].rings[0])
        if (shell.points[corner].z < base.z) base = shell.points[corner];
    double volume = 0;
    std::size_t turned = 0;
    for (const std::uint32_t f : component) {
      volume += (state[f] == kTurn ? -1 : 1) * volume_under(shell, shell.faces[f], base);
      turned += state[f] == kTurn ? 1u : 0u;
    }
    // A flat open patch has no inside: the majority of its faces decides.
    const bool outwards =
        volume != 0 ? (volume > 0) != shell.faces[seed].cavity : turned * 2 <= component.size();
    for (const std::uint32_t f : component)
      if ((state[f] == kTurn) == outwards) {
        turn(shell.faces[f]);
        context.note("turned", shell.surface_ids[shell.faces[f].source]);
      }
  }
}

void drop_duplicate_faces(Shell& shell, StepContext& context) {
  std::map<Ring, std::vector<std::uint32_t>> groups;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
    Ring corners;
    for (const Ring& ring : shell.faces[f].rings)
      corners.insert(corners.end(), ring.begin(), ring.end());
    std::sort(corners.begin(), corners.end());
    groups[std::move(corners)].push_back(f);
  }
  std::vector<char> gone(shell.faces.size(), 0);
  std::optional<EdgeUses> uses;
  for (const auto& [corners, faces] : groups) {
    if (faces.size() < 2) continue;
    if (!uses) uses.emplace(shell);
    // An inner wall is one whose edges pair up without it.
    bool inner = true;
    for (const Ring& ring : shell.faces[faces[0]].rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::size_t others =
            uses->of(ring[i], ring[(i + 1) % ring.size()]).size() - faces.size();
        inner = inner && others % 2 == 0;
      }
    for (std::size_t i = inner ? 0 : 1; i < faces.size(); ++i) {
      gone[faces[i]] = 1;
      context.note(inner ? "inner_face_dropped" : "duplicate_face_dropped",
                   shell.surface_ids[shell.faces[faces[i]].source]);
    }
  }
  std::vector<Face> kept;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f)
    if (!gone[f]) kept.push_back(std::move(shell.faces[f]));
  shell.faces = std::move(kept);
}

void type_faces(Shell& shell) {
  for (Face& face : shell.faces) {
    if (face.type != SurfaceType::Unknown) continue;
    const Point3 n = ring_normal(shell.points, face.rings[0]);
    const double length = std::hypot(n.x, n.y, n.z);
    constexpr double kWallSlope = 0.17;  // walls are within 10 degrees of the vertical
    face.type = n.z > kWallSlope * length    ? SurfaceType::RoofSurface
                : n.z < -kWallSlope * length ? SurfaceType::GroundSurface
                                             : SurfaceType::WallSurface;
  }
}

}  // namespace citymesh
