#include "core/pipeline/separate_bodies.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "core/base/union_find.h"
#include "core/geometry/box_tree.h"
#include "core/heal/heal.h"
#include "core/pipeline/parts.h"
#include "core/pipeline/round_trip_gate.h"
#include "core/reconstruct/push_out.h"
#include "core/validate/body.h"
#include "core/validate/validate.h"

namespace citymesh {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Cluster = std::vector<std::uint32_t>;

/// Tried one after the other; walls that are nearly one need the larger ones.
constexpr std::array kTolerances_m{0.0015, 0.005, 0.02, 0.05};

/// Walls that reach no deeper into a neighbour are meant to be one with its wall.
constexpr double kSliver_m = 0.05;
// Two bodies are pushed in turn, each time a little farther: where one gives way its faces tilt,
// and may reach into the other elsewhere.
constexpr std::size_t kPushes = 10;
constexpr double kClearance = 2;  ///< steps
constexpr double kGrowth = 1.5;

ClosedSurface surface_of(const TriangleMesh& mesh) {
  ClosedSurface surface{mesh.points, mesh.triangles, {}};
  if (mesh.points.empty()) return surface;
  surface.box = GridBox::of(mesh.points[0]);
  for (const GridPoint& p : mesh.points) surface.box.add(p);
  return surface;
}

class Separation {
 public:
  Separation(const std::vector<Body>& bodies, const Inputs& inputs,
             const std::vector<OpenFormat>& formats, const RunContext& context)
      : bodies_(bodies),
        inputs_(inputs),
        formats_(formats),
        context_(context),
        clusters_(bodies.size()),
        separated_(bodies.size()),
        spaces_(bodies.size()) {
    for (const Body& body : bodies) surfaces_.push_back(surface_of(body.mesh));
  }

  /// Bodies that overlap give way together. One that gave way may reach, by a rounding, into one
  /// that only touched it: that one joins them and all give way anew.
  void run() {
    constexpr int kRounds = 6;
    std::vector<char> changed(bodies_.size(), 1);
    for (int round = 0; round < kRounds; ++round) {
      find_overlaps(changed);
      UnionFind wanted = clusters_;
      std::vector<Pair> pairs;
      for (const Pair& pair : overlaps_)
        if (!refused_.contains(pair)) {
          pairs.push_back(pair);
          wanted.join(pair.first, pair.second);
        }
      if (pairs.empty()) return;
      std::fill(changed.begin(), changed.end(), 0);
      std::map<std::uint32_t, std::vector<Pair>> pairs_of;
      for (const Pair& pair : pairs) pairs_of[wanted.root(pair.first)].push_back(pair);
      for (const auto& [root, joining] : pairs_of) separate(joining, changed);
      std::erase_if(refused_,
                    [&](const Pair& pair) { return changed[pair.first] || changed[pair.second]; });
    }
    find_overlaps(changed);
  }

  SeparatedBodies take() && {
    SeparatedBodies result{std::move(separated_), std::move(spaces_), {}};
    result.overlaps.reserve(overlaps_.size());
    for (const auto& [a, b] : overlaps_)
      result.overlaps.push_back({a, b, common_place(surfaces_[a], surfaces_[b])});
    return result;
  }

 private:
  /// Asks again all pairs of which one body is `changed`.
  void find_overlaps(const std::vector<char>& changed) {
    std::erase_if(overlaps_,
                  [&](const Pair& pair) { return changed[pair.first] || changed[pair.second]; });
    std::vector<GridBox> boxes;
    std::vector<std::uint32_t> parts;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
      if (!is_part(bodies_[i]) || surfaces_[i].triangles.empty()) continue;
      parts.push_back(i);
      boxes.push_back(surfaces_[i].box);
    }
    const BoxTree tree(boxes);
    for (std::uint32_t k = 0; k < parts.size(); ++k)
      tree.for_each_meeting(boxes[k], [&](std::uint32_t m) {
        const std::uint32_t i = parts[k], j = parts[m];
        if (i < j && (changed[i] || changed[j]) && are_overlapping(i, j)) overlaps_.insert({i, j});
      });
  }

  bool are_overlapping(std::uint32_t i, std::uint32_t j) {
    const Answer answer = interiors_overlap(surfaces_[i], surfaces_[j]);
    if (answer != Answer::Maybe) return answer == Answer::Yes;
    // Both have been cut along each other already, or they coincide in part: cutting them tells.
    if (clusters_.root(i) == clusters_.root(j)) return false;
    return have_common_space(mesh_of(i), mesh_of(j));
  }

  /// Cutting them along each other tells.
  bool have_common_space(const TriangleMesh& a, const TriangleMesh& b) const {
    const Shell pair[] = {shell_of(a), shell_of(b)};
    const auto shared = shared_space(pair, {}, context_);
    return shared && !shared->empty();
  }

  /// Slivers are pushed away; what then still overlaps is cut, all at once or, where that fails,
  /// pair by pair, as far as it goes.
  void separate(const std::vector<Pair>& all, std::vector<char>& changed) {
    std::vector<Pair> pairs;
    for (const Pair& pair : all)
      if (!push_apart(pair, changed) && !push_apart({pair.second, pair.first}, changed))
        pairs.push_back(pair);
    if (pairs.empty()) return;
    const bool all_joined = std::all_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
      return clusters_.root(pair.first) == clusters_.root(pair.second);
    });
    if (pairs.size() > 1 && !all_joined && separate_joined(pairs, changed)) return;
    for (const Pair& pair : pairs) {
      const bool joined = clusters_.root(pair.first) == clusters_.root(pair.second);
      if ((joined || !separate_joined({&pair, 1}, changed)) && !separate_alone(pair, changed))
        refused_.insert(pair);
    }
  }

  const TriangleMesh& mesh_of(std::uint32_t body) const {
    return separated_[body] ? separated_[body]->mesh : bodies_[body].mesh;
  }

  /// Moves corners of one of the two, the first one first, or of both, until they have nothing in
  /// common. False: they overlap by more than a sliver, or it does not come to an end.
  bool push_apart(const Pair& pair, std::vector<char>& changed) {
    const double reach_m = std::min(kSliver_m, inputs_.max_displacement_m);
    const std::array<std::uint32_t, 2> bodies{pair.first, pair.second};
    std::array<std::optional<Separated>, 2> pushed;
    std::array<ClosedSurface, 2> surfaces{surfaces_[bodies[0]], surfaces_[bodies[1]]};
    std::size_t idle = 0;  // turns since a corner moved
    double clearance = kClearance;
    for (std::size_t turn = 0; turn < kPushes; ++turn, clearance *= kGrowth) {
      const std::size_t k = turn % 2;
      const TriangleMesh& mesh = pushed[k] ? pushed[k]->mesh : mesh_of(bodies[k]);
      auto out = push_out({mesh.points, mesh.triangles},
                          {surfaces[1 - k].points, surfaces[1 - k].triangles}, reach_m, clearance);
      if (out) {
        Shell shell = shell_of(mesh);
        shell.points = std::move(out->points);
        auto fit = fitted(std::move(shell));
        if (!fit) return false;
        fit->pushes = pushed[k] ? pushed[k]->pushes : pushes_of(bodies[k]);
        fit->pushes.push_back({bodies[1 - k], out->displacement_m, out->at});
        pushed[k] = std::move(fit);
        surfaces[k] = surface_of(pushed[k]->mesh);
      }
      const Answer answer = interiors_overlap(surfaces[0], surfaces[1]);
      idle = out ? 0 : idle + 1;
      const bool nothing_left = idle == 2;
      if (answer == Answer::Yes && nothing_left) return false;
      if (answer == Answer::Yes || (answer == Answer::Maybe && !nothing_left)) continue;
      if (answer == Answer::Maybe &&
          have_common_space(pushed[0] ? pushed[0]->mesh : mesh_of(bodies[0]),
                            pushed[1] ? pushed[1]->mesh : mesh_of(bodies[1])))
        return false;
      for (std::size_t i = 0; i < 2; ++i) {
        if (!pushed[i]) continue;
        surfaces_[bodies[i]] = surface_of(pushed[i]->mesh);
        separated_[bodies[i]] = std::move(pushed[i]);
        changed[bodies[i]] = 1;
      }
      return true;
    }
    return false;
  }

  std::vector<Push> pushes_of(std::uint32_t body) const {
    return separated_[body] ? separated_[body]->pushes : std::vector<Push>{};
  }

  bool separate_joined(std::span<const Pair> pairs, std::vector<char>& changed) {
    UnionFind joined = clusters_;
    for (const auto& [a, b] : pairs) joined.join(a, b);
    Cluster cluster;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i)
      if (joined.root(i) == joined.root(pairs[0].first)) cluster.push_back(i);
    for (const double tolerance_m : kTolerances_m) {
      if (tolerance_m > inputs_.max_displacement_m || context_.stopped()) break;
      if (!separate(cluster, tolerance_m)) continue;
      clusters_ = std::move(joined);
      for (const std::uint32_t i : cluster) changed[i] = 1;
      return true;
    }
    return false;
  }

  /// The two as they are now, without those that they have given way to before.
  bool separate_alone(const Pair& pair, std::vector<char>& changed) {
    if (!separated_[pair.first] && !separated_[pair.second]) return false;  // that was tried
    for (const double tolerance_m : kTolerances_m) {
      if (tolerance_m > inputs_.max_displacement_m || context_.stopped()) break;
      if (!separate({pair.first, pair.second}, tolerance_m, true)) continue;
      changed[pair.first] = changed[pair.second] = 1;
      return true;
    }
    return false;
  }

  /// Bodies as they came, or as they are `now`. False: a limit was reached or a gate does not hold.
  bool separate(const Cluster& cluster, double tolerance_m, bool now = false) {
    std::vector<Shell> shells;
    for (const std::uint32_t i : cluster)
      shells.push_back(shell_of(now ? mesh_of(i) : bodies_[i].mesh));
    auto shared = share_space(shells, {tolerance_m}, context_);
    if (!shared) return false;
    std::vector<Separated> results;
    for (Shell& shell : shared->bodies) {
      auto fit = shell.faces.empty() ? Separated{} : fitted(std::move(shell));
      if (!fit) return false;
      results.push_back(std::move(*fit));
    }
    for (std::size_t k = 0; k < cluster.size(); ++k) {
      surfaces_[cluster[k]] = surface_of(results[k].mesh);
      separated_[cluster[k]] = std::move(results[k]);
      if (!now) spaces_[cluster[k]].clear();
    }
    for (const SharedSpace& space : shared->spaces) {
      spaces_[cluster[space.from]].push_back(space);
      spaces_[cluster[space.from]].back().to = cluster[space.to];
    }
    return true;
  }

  /// Through the delivery gates and without defects, or not at all.
  std::optional<Separated> fitted(Shell shell) const {
    RoundTripGate gate(formats_);
    std::vector<GridPoint> cuts;
    if (!make_fit(shell, inputs_.planarity_tolerance_m, std::ref(gate), cuts).empty()) return {};
    Separated result;
    result.issues = validate(shell, {.snap_tolerance_m = inputs_.snap_tolerance_m,
                                     .planarity_tolerance_m = inputs_.planarity_tolerance_m});
    if (std::any_of(result.issues.begin(), result.issues.end(),
                    [](const Issue& issue) { return is_defect(issue.code); }))
      return {};
    result.mesh = gate.take_mesh();
    result.fingerprint = gate.fingerprint();
    return result;
  }

  const std::vector<Body>& bodies_;
  const Inputs& inputs_;
  const std::vector<OpenFormat>& formats_;
  const RunContext& context_;
  std::vector<ClosedSurface> surfaces_;
  std::set<Pair> overlaps_;
  UnionFind clusters_;
  std::set<Pair> refused_;
  std::vector<std::optional<Separated>> separated_;
  std::vector<std::vector<SharedSpace>> spaces_;
};

}  // namespace

SeparatedBodies separate_bodies(const std::vector<Body>& bodies, const Inputs& inputs,
                                const std::vector<OpenFormat>& formats, const RunContext& context) {
  Separation separation(bodies, inputs, formats, context);
  separation.run();
  return std::move(separation).take();
}

}  // namespace citymesh
