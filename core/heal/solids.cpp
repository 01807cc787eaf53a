#include <algorithm>
#include <utility>

#include "core/base/union_find.h"
#include "core/geometry/locate.h"
#include "core/geometry/measure.h"
#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"

namespace citymesh {
namespace {

/// Faces that hang together.
struct Component {
  std::vector<std::uint32_t> faces{};
  std::size_t exterior = 0;  ///< place in the order of exteriors; of a cavity: of what it hollows
  bool cavity = false;
};

std::vector<Component> components_of(const Shell& shell) {
  UnionFind joined(shell.points.size());
  for (const Face& face : shell.faces)
    for (const Ring& ring : face.rings)
      for (const std::uint32_t corner : ring) joined.join(face.rings[0][0], corner);
  constexpr std::size_t kNew = ~std::size_t{0};
  std::vector<std::size_t> number_of(shell.points.size(), kNew);
  std::vector<Component> components;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
    std::size_t& number = number_of[joined.root(shell.faces[f].rings[0][0])];
    if (number == kNew) {
      number = components.size();
      components.push_back({});
      components.back().cavity = shell.faces[f].cavity;
    }
    components[number].faces.push_back(f);
  }
  return components;
}

std::vector<Triangle> triangles_of(const Shell& shell, const Component& component) {
  std::vector<Triangle> triangles;
  for (const std::uint32_t f : component.faces)
    if (const auto found = triangulate(shell.points, shell.faces[f].rings))
      triangles.insert(triangles.end(), found->begin(), found->end());
  return triangles;
}

bool contains(const Shell& shell, const Component& outer, const Component& inner) {
  const std::vector<Triangle> triangles = triangles_of(shell, outer);
  const GridPoint& place = shell.points[shell.faces[inner.faces[0]].rings[0][0]];
  return Locator(shell.points, triangles).locate(place) == Side::Inside;
}

}  // namespace

void group_solids(Shell& shell) {
  const auto is_empty = [](const Face& face) {
    return face.rings.empty() || face.rings[0].empty();
  };
  if (std::any_of(shell.faces.begin(), shell.faces.end(), is_empty)) return;
  std::vector<Component> components = components_of(shell);
  if (components.size() < 2) return;
  // A hollow that a step has made looks inwards without being called a cavity.
  std::vector<char> inward;
  inward.reserve(components.size());
  for (const Component& component : components)
    inward.push_back(component.cavity || volume6(shell.points, triangles_of(shell, component)) < 0);
  std::size_t next = 0;
  for (std::size_t c = 0; c < components.size(); ++c)
    if (!inward[c]) components[c].exterior = next++;
  for (std::size_t c = 0; c < components.size(); ++c) {
    if (!inward[c]) continue;
    Component& cavity = components[c];
    // Of nested ones the innermost.
    const Component* host = nullptr;
    for (std::size_t o = 0; o < components.size(); ++o)
      if (!inward[o] && contains(shell, components[o], cavity) &&
          (!host || contains(shell, *host, components[o])))
        host = &components[o];
    if (host) {
      cavity.exterior = host->exterior;
      cavity.cavity = true;
      for (const std::uint32_t f : cavity.faces) shell.faces[f].cavity = true;
    } else if (!cavity.cavity) {
      cavity.exterior = next++;
    }
  }
  std::stable_sort(components.begin(), components.end(),
                   [](const Component& a, const Component& b) {
                     return std::pair(a.exterior, a.cavity) < std::pair(b.exterior, b.cavity);
                   });
  std::vector<Face> faces;
  faces.reserve(shell.faces.size());
  for (const Component& component : components)
    for (const std::uint32_t f : component.faces) faces.push_back(std::move(shell.faces[f]));
  shell.faces = std::move(faces);
}

}  // namespace citymesh
