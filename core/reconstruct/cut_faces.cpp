#include "core/reconstruct/cut_faces.h"

#include <algorithm>

#include "core/geometry/triangulation.h"
#include "core/reconstruct/close_chain.h"

namespace citymesh {
namespace {

constexpr double kMinTolerance_m = 0.0015;     ///< above the height that the gates ask of triangles
constexpr std::size_t kMaxTriangles = 20'000;  ///< of the input; work limits
constexpr std::uint64_t kMaxFacets = 60'000;
constexpr std::uint64_t kMaxCuts = 8'000;

ArrangeOptions limits_of(double tolerance_m, std::uint64_t max_cuts, const RunContext& context) {
  ArrangeOptions limits;
  limits.max_facets = kMaxFacets;
  limits.max_cuts = max_cuts;
  limits.stop = context.stop;
  limits.tolerance_m = std::max(tolerance_m, kMinTolerance_m);
  return limits;
}

/// Arranges again with triangles that close the gaps; their input index is `gap`.
std::optional<Arrangement> closed(Arrangement first, std::uint32_t gap,
                                  const ArrangeOptions& limits) {
  const std::vector<Triangle> patches = closing_triangles(first);
  if (patches.empty()) return first;
  std::vector<Triangle> all = first.facets;
  all.insert(all.end(), patches.begin(), patches.end());
  auto second = arrange(first.points, all, limits);
  if (!second) return {};
  for (std::vector<Cover>& covers : second->covers) {
    std::vector<Cover> resolved;
    for (const Cover& cover : covers)
      if (cover.input >= first.facets.size())
        resolved.push_back({gap, cover.along});
      else
        for (const Cover& original : first.covers[cover.input])
          resolved.push_back({original.input, original.along == cover.along});
    covers = std::move(resolved);
  }
  return second;
}

}  // namespace

std::optional<CutFaces> cut_faces(const Shell& input, double tolerance_m, std::uint64_t max_cuts,
                                  const RunContext& context) {
  CutFaces cut;
  std::vector<Triangle> triangles;
  for (std::uint32_t f = 0; f < input.faces.size(); ++f)
    if (const auto pieces = triangulate(input.points, input.faces[f].rings)) {
      triangles.insert(triangles.end(), pieces->begin(), pieces->end());
      cut.face_of.resize(triangles.size(), f);
    }
  if (triangles.size() > kMaxTriangles) return {};
  auto arrangement = arrange(input.points, triangles, limits_of(tolerance_m, max_cuts, context));
  if (!arrangement || context.stopped()) return {};
  cut.arrangement = std::move(*arrangement);
  return cut;
}

std::optional<CutFaces> cut_and_closed_faces(const Shell& input, double tolerance_m,
                                             const RunContext& context) {
  auto cut = cut_faces(input, tolerance_m, kMaxCuts, context);
  if (!cut) return {};
  auto arrangement =
      closed(std::move(cut->arrangement), static_cast<std::uint32_t>(cut->face_of.size()),
             limits_of(tolerance_m, kMaxCuts, context));
  if (!arrangement || context.stopped()) return {};
  cut->arrangement = std::move(*arrangement);
  cut->face_of.push_back(static_cast<std::uint32_t>(input.faces.size()));
  return cut;
}

std::uint32_t parent_of(std::span<const Cover> covers, bool along,
                        const std::vector<std::uint32_t>& face_of, const Shell& input) {
  const auto rank = [&](const Cover& cover) {
    const std::uint32_t face = face_of[cover.input];
    const bool added = face == input.faces.size() || input.faces[face].added;
    return (cover.along == along ? 0 : 1) + (added ? 2 : 0);
  };
  const auto best =
      std::min_element(covers.begin(), covers.end(),
                       [&](const Cover& s, const Cover& t) { return rank(s) < rank(t); });
  return best == covers.end() ? static_cast<std::uint32_t>(input.faces.size())
                              : face_of[best->input];
}

Shell joined(std::span<const Shell> shells) {
  Shell all;
  all.surface_ids.emplace_back();
  for (const Shell& shell : shells) {
    const auto first_point = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), shell.points.begin(), shell.points.end());
    const auto first_id = static_cast<std::uint32_t>(all.surface_ids.size());
    all.surface_ids.insert(all.surface_ids.end(), shell.surface_ids.begin(),
                           shell.surface_ids.end());
    for (Face face : shell.faces) {
      face.source += first_id;
      for (Ring& ring : face.rings)
        for (std::uint32_t& corner : ring) corner += first_point;
      all.faces.push_back(std::move(face));
    }
  }
  return all;
}

}  // namespace citymesh
