#include "core/validate/solids.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/union_find.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/validate/volumes.h"

namespace citymesh {
namespace {

/// Facing outwards, without points that no triangle uses.
ClosedSurface surface_of(const Boundary& boundary, bool turn) {
  ClosedSurface surface;
  constexpr std::uint32_t kNew = ~0u;
  std::vector<std::uint32_t> number(boundary.points.size(), kNew);
  for (Triangle t : boundary.triangles) {
    if (turn) std::swap(t[1], t[2]);
    for (std::uint32_t& corner : t) {
      if (number[corner] == kNew) {
        number[corner] = static_cast<std::uint32_t>(surface.points.size());
        surface.points.push_back(boundary.points[corner]);
      }
      corner = number[corner];
    }
    surface.triangles.push_back(t);
  }
  surface.box = GridBox::of(surface.points[0]);
  for (const GridPoint& p : surface.points) surface.box.add(p);
  return surface;
}

bool is_within(const ClosedSurface& inner, const ClosedSurface& outer) {
  const Answer answer = lies_within(inner, outer);
  return answer == Answer::Maybe ? volume_within(inner, outer).value_or(true)
                                 : answer == Answer::Yes;
}

bool are_overlapping(const SolidBody& a, const SolidBody& b) {
  const Answer answer = interiors_overlap(a.exterior, b.exterior);
  if (answer == Answer::No) return false;
  if (answer == Answer::Yes && a.cavities.empty() && b.cavities.empty()) return true;
  return volumes_overlap(a, b).value_or(answer == Answer::Yes);
}

bool are_same(const ClosedSurface& a, const ClosedSurface& b) {
  return a.box.min == b.box.min && a.box.max == b.box.max &&
         volume6(a.points, a.triangles) == volume6(b.points, b.triangles) && is_within(a, b) &&
         is_within(b, a);
}

bool are_same(const SolidBody& a, const SolidBody& b) {
  if (a.cavities.size() != b.cavities.size() || !are_same(a.exterior, b.exterior)) return false;
  return std::all_of(a.cavities.begin(), a.cavities.end(), [&](const ClosedSurface& cavity) {
    return std::any_of(b.cavities.begin(), b.cavities.end(),
                       [&](const ClosedSurface& other) { return are_same(cavity, other); });
  });
}

/// Calls visit(i, j), i < j, for solids whose boxes meet, in order.
template <class Visit>
void for_each_near(std::span<const SolidBody* const> solids, Visit&& visit) {
  std::vector<GridBox> boxes;
  for (const SolidBody* solid : solids) boxes.push_back(solid->exterior.box);
  const BoxTree tree(boxes);
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    std::vector<std::uint32_t> near;
    tree.for_each_meeting(boxes[i], [&](std::uint32_t j) {
      if (j > i) near.push_back(j);
    });
    std::sort(near.begin(), near.end());
    for (const std::uint32_t j : near) visit(i, j);
  }
}

}  // namespace

std::optional<SolidBody> check_solid_level(std::span<const Boundary> shells, std::string name,
                                           Findings& findings) {
  const std::size_t before = findings.count();
  SolidBody solid;
  solid.name = std::move(name);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    const Int128 volume = volume6(shells[s].points, shells[s].triangles);
    const bool wanted = s == 0 ? volume > 0 : volume < 0;
    if (!wanted)
      findings.add(
          405, [&] { return shells[s].name + (s == 0 ? "looks inward" : "looks outward"); },
          static_cast<double>(volume) / 6e12,
          to_metres(shells[s].points[shells[s].triangles[0][0]]));
    ClosedSurface surface = surface_of(shells[s], volume < 0);
    if (s == 0)
      solid.exterior = std::move(surface);
    else
      solid.cavities.push_back(std::move(surface));
  }
  if (findings.count() != before) return {};

  const auto report = [&](int code, std::size_t shell, std::size_t other, const Point3& at) {
    findings.add(
        code, [&] { return shells[shell].name + "with " + shells[other].name; }, 0, at);
  };
  const ClosedSurface& outer = solid.exterior;
  for (std::size_t i = 0; i < solid.cavities.size(); ++i) {
    const ClosedSurface& inner = solid.cavities[i];
    const Point3 at = to_metres(inner.points[0]);
    if (are_same(inner, outer))
      report(402, i + 1, 0, at);
    else if (!is_within(inner, outer))
      report(touch_or_overlap(inner, outer) ? 401 : 403, i + 1, 0, at);
    else if (share_area(inner, outer))
      report(401, i + 1, 0, common_place(inner, outer));
  }
  for (std::size_t i = 0; i < solid.cavities.size(); ++i)
    for (std::size_t j = i + 1; j < solid.cavities.size(); ++j) {
      const ClosedSurface &a = solid.cavities[i], &b = solid.cavities[j];
      if (!a.box.meets(b.box)) continue;
      if (are_same(a, b))
        report(402, j + 1, i + 1, to_metres(b.points[0]));
      else if (are_overlapping({"", a, {}}, {"", b, {}}) || share_area(a, b))
        report(401, j + 1, i + 1, common_place(a, b));
    }
  if (findings.count() != before) return {};
  if (solid.cavities.empty()) return solid;

  // Only where shells touch can they cut the inside into pieces.
  bool any_touch = false;
  for (std::size_t i = 0; i < shells.size(); ++i)
    for (std::size_t j = i + 1; j < shells.size(); ++j)
      any_touch = any_touch ||
                  surfaces_touch(i == 0 ? outer : solid.cavities[i - 1], solid.cavities[j - 1]);
  if (any_touch)
    if (const auto pieces = interior_pieces(solid); pieces && *pieces > 1) {
      findings.add(
          404, [&] { return solid.name; }, static_cast<double>(*pieces),
          to_metres(outer.points[0]));
      return {};
    }
  return solid;
}

bool check_overlaps(std::span<const SolidBody* const> solids, int code, Findings& findings) {
  bool none = true;
  for_each_near(solids, [&](std::uint32_t i, std::uint32_t j) {
    const SolidBody &a = *solids[i], &b = *solids[j];
    if (!are_overlapping(a, b)) return;
    none = false;
    findings.add(
        code, [&] { return a.name + " with " + b.name; }, 0, common_place(a.exterior, b.exterior));
  });
  return none;
}

void check_composite(std::span<const SolidBody> solids, Findings& findings) {
  std::vector<const SolidBody*> all;
  for (const SolidBody& solid : solids) all.push_back(&solid);
  bool any_same = false;
  for_each_near(all, [&](std::uint32_t i, std::uint32_t j) {
    if (!are_same(solids[i], solids[j])) return;
    any_same = true;
    findings.add(
        502, [&] { return solids[i].name + " with " + solids[j].name; }, 0,
        to_metres(solids[i].exterior.points[0]));
  });
  if (any_same || !check_overlaps(all, 501, findings)) return;

  UnionFind joined(solids.size());
  std::size_t pieces = solids.size();
  for_each_near(all, [&](std::uint32_t i, std::uint32_t j) {
    if (joined.root(i) != joined.root(j) && share_area(solids[i].exterior, solids[j].exterior)) {
      joined.join(i, j);
      --pieces;
    }
  });
  if (pieces < 2) return;
  for (std::uint32_t i = 1; i < solids.size(); ++i)
    if (joined.root(i) == i)
      findings.add(
          503, [&] { return solids[i].name + " is apart from " + solids[0].name; },
          static_cast<double>(pieces), to_metres(solids[i].exterior.points[0]));
}

}  // namespace citymesh
