#include "core/heal/heal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/citymodel/choose.h"
#include "core/citymodel/edges.h"
#include "core/citymodel/grid.h"
#include "core/geometry/box_tree.h"
#include "core/geometry/place.h"
#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"
#include "core/reconstruct/lane.h"
#include "core/reconstruct/rebuild_2_5d.h"
#include "core/reconstruct/rebuild_3d.h"
#include "core/reconstruct/wrap.h"
#include "core/validate/validate.h"

namespace citymesh {
namespace {

struct HealStep {
  std::string_view name;
  void (*apply)(Shell&, StepContext&);
};

// Rings are clean before edges mean something; edges match before duplicates and orientation;
// orientation agrees before free edges form loops; closing may turn an open patch into the inside
// of a body, so orientation is found again.
constexpr std::array kHealSteps{
    HealStep{"snap_points", snap_points},
    HealStep{"clean_rings", clean_rings},
    HealStep{"insert_junctions", insert_junctions},
    HealStep{"clean_rings", clean_rings},
    HealStep{"drop_broken_faces", drop_broken_faces},
    HealStep{"drop_duplicate_faces", drop_duplicate_faces},
    HealStep{"drop_inner_sheets", drop_inner_sheets},
    HealStep{"orient_faces", orient_faces},
    HealStep{"close_holes", close_holes},
    HealStep{"restore_broken_faces", restore_broken_faces},
    HealStep{"orient_faces", orient_faces},
};

void prepare(Shell& shell, StepContext& step) {
  for (const HealStep& heal_step : kHealSteps) heal_step.apply(shell, step);
}

/// Tolerances of rung `healed` after the one asked for, as long as they stay below the limit of
/// displacement.
constexpr std::array kWiderTolerances_m{0.005, 0.02, 0.05};

/// Work limit of rung `healed`: faces of all attempts; one attempt is always made.
constexpr std::size_t kMaxFacesTried = 200'000;

bool is_opening(SurfaceType type) {
  return type == SurfaceType::Window || type == SurfaceType::Door;
}

/// Corner mean of a face, in metres.
Point3 centre_of(const Shell& shell, const Face& face) {
  Point3 sum{};
  for (const std::uint32_t corner : face.rings[0]) {
    const Point3 p = to_metres(shell.points[corner]);
    sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
  }
  const auto n = static_cast<double>(face.rings[0].size());
  return {sum.x / n, sum.y / n, sum.z / n};
}

/// Takes the openings out of a shell and later gives their type and source to the faces that close
/// their holes.
class Openings {
 public:
  explicit Openings(Shell& shell) {
    for (const Face& face : shell.faces)
      if (is_opening(face.type) && !face.rings.empty() && !face.rings[0].empty())
        openings_.push_back({centre_of(shell, face), face.type, face.source});
    std::erase_if(shell.faces, [](const Face& face) { return is_opening(face.type); });
  }

  void give_back(Shell& shell) const {
    for (Face& face : shell.faces) {
      if (face.type != SurfaceType::ClosureSurface || face.source != 0) continue;
      const Point3 centre = centre_of(shell, face);
      double nearest_m = kRevealDepth_m;
      for (const Opening& opening : openings_) {
        const double d = std::hypot(centre.x - opening.centre.x, centre.y - opening.centre.y,
                                    centre.z - opening.centre.z);
        if (d >= nearest_m) continue;
        nearest_m = d;
        face.type = opening.type;
        face.source = opening.source;
      }
    }
  }

 private:
  static constexpr double kRevealDepth_m =
      0.5;  ///< how far behind its wall a window or door may lie

  struct Opening {
    Point3 centre{};
    SurfaceType type{};
    std::uint32_t source = 0;
  };
  std::vector<Opening> openings_;
};

/// What of a shell can be triangulated, as a reference to measure from.
template <class Counts>
std::vector<Triangle> triangles_of(const Shell& shell, Counts&& counts) {
  std::vector<Triangle> all;
  for (const Face& face : shell.faces) {
    if (!counts(face)) continue;
    if (const auto triangles = triangulate(shell.points, face.rings))
      all.insert(all.end(), triangles->begin(), triangles->end());
  }
  return all;
}

bool any_face(const Face&) { return true; }

/// Two-sided distance. Faces that close holes, or stand for polygons that enclose no area as they
/// cross themselves, are no deviation, but what they cover is found there.
Deviation deviation_between(const Shell& raw, const Shell& result) {
  // A face that only repeats a corner has no triangles, but is no gap either.
  Shell input = raw;
  StepContext unnoted;
  clean_rings(input, unnoted);
  std::vector<char> measurable(std::max(raw.surface_ids.size(), result.surface_ids.size()), 0);
  measurable[0] = 1;  // of faces without a name nothing is known
  for (const Face& face : input.faces)
    if (triangulate(input.points, face.rings)) measurable[face.source] = 1;
  const auto of_input = [&](const Face& face) { return !face.added && measurable[face.source]; };
  const auto before = triangles_of(input, any_face), after = triangles_of(result, any_face);
  return two_sided(
      deviation_to({input.points, before}, {result.points, after}),
      deviation_to({result.points, triangles_of(result, of_input)}, {input.points, before}));
}

/// The rungs between `healed` and the block, best first; each takes the same input anew.
struct Rebuild {
  std::string_view rung;
  Reconstruction reconstruct;
  bool prepared;  ///< takes what the steps of `healed` made of the input
  bool widens;    ///< is tried again with wider tolerances
};
constexpr std::array kRebuilds{
    Rebuild{"rebuilt_2_5d", rebuild_2_5d, false, true},
    Rebuild{"rebuilt_3d", rebuild_3d, true, true},
    Rebuild{"wrapped", wrap, false, false},
};

/// Beyond so many faces a rebuilding rung is tried with one tolerance only.
constexpr std::size_t kManyFaces = 400;

class Ladder {
 public:
  Ladder(const Building& building, const HealOptions& options, const DeliveryGate& gate,
         const RunContext& context)
      : building_(building), options_(options), gate_(gate), context_(context) {}

  Healed climb(std::span<const Lod> lod) {
    const auto geometries = choose_geometries(building_, lod);
    if (geometries.empty()) {
      result_.reason = "no_geometry";
      return std::move(result_);
    }
    result_.lod = geometries[0]->lod;
    std::optional<Gridded> first;
    std::vector<Gridded> rebuildable;
    for (const Geometry* geometry : geometries) {
      auto gridded = grid(building_, *geometry);
      if (const Issue* issue = std::get_if<Issue>(&gridded)) {
        result_.issues.push_back(*issue);
        continue;
      }
      Gridded& input = std::get<Gridded>(gridded);
      if (!first) {
        first = input;
        result_.issues = validate(building_, *geometry,
                                  {options_.snap_tolerance_m, options_.planarity_tolerance_m})
                             .issues;
        if (is_closed(input.shell))
          result_.volume_before_m3 =
              volume_m3(input.shell.points, triangles_of(input.shell, any_face));
      }
      if (geometry->footprint) continue;
      if (try_as_is(input) || try_healed(input)) return std::move(result_);
      if (context_.stopped()) break;
      rebuildable.push_back(std::move(input));
    }
    for (const Rebuild& rebuild : kRebuilds)
      for (const Gridded& input : rebuildable)
        if (try_rebuilt(rebuild, input)) return std::move(result_);
    if (!first)
      result_.reason = "no_geometry";
    else if (!try_block(*first, geometries[0]->footprint) && result_.reason.empty())
      result_.reason = "not_healed";
    return std::move(result_);
  }

 private:
  bool try_as_is(const Gridded& input) {
    Shell shell = input.shell;
    StepContext step = step_context(options_.snap_tolerance_m);
    const std::vector<Issue> refused = fits(shell, step);
    for (const Issue& issue : refused)  // of what was cut they would say nothing of the input
      if (step.repairs.empty() &&
          std::none_of(result_.issues.begin(), result_.issues.end(),
                       [&](const Issue& known) { return known.code == issue.code; }))
        result_.issues.push_back(issue);
    if (!refused.empty()) return false;
    result_.max_displacement_m = input.max_displacement_m;
    result_.repairs = std::move(step.repairs);
    return deliver(result_.repairs.empty() ? "as_is" : "healed", std::move(shell));
  }

  bool try_healed(const Gridded& input) {
    std::size_t faces_tried = 0;
    const bool has_openings = std::any_of(input.shell.faces.begin(), input.shell.faces.end(),
                                          [](const Face& face) { return is_opening(face.type); });
    for (const double tolerance_m : tolerances_m())
      for (int without_openings = 0; without_openings <= (has_openings ? 1 : 0);
           ++without_openings) {
        if (context_.stopped() || faces_tried > kMaxFacesTried) return false;
        faces_tried += input.shell.faces.size();
        Shell shell = input.shell;
        StepContext step = step_context(tolerance_m);
        // An opening in front of or behind its wall leaves the wall open: the wall is closed
        // instead.
        std::optional<Openings> openings;
        if (without_openings) {
          openings.emplace(shell);
          step.note("openings_closed", building_.gml_id);
        }
        prepare(shell, step);
        drop_double_triangles(shell, step);
        if (openings) openings->give_back(shell);
        if (shell.faces.empty() || step.max_displacement_m > options_.max_displacement_m) continue;
        if (!is_closed(shell)) continue;  // no gate would pass it
        if (!fits(shell, step).empty()) continue;
        result_.max_displacement_m = std::max(input.max_displacement_m, step.max_displacement_m);
        result_.repairs = std::move(step.repairs);
        result_.deviation = deviation_between(input.shell, shell);
        return deliver("healed", std::move(shell));
      }
    return false;
  }

  /// A rung that builds the boundary anew, with growing tolerances.
  bool try_rebuilt(const Rebuild& rebuild, const Gridded& input) {
    for (const double tolerance_m : tolerances_m()) {
      if (context_.stopped()) return false;
      const bool once = !rebuild.widens || input.shell.faces.size() > kManyFaces;
      if (once && tolerance_m > options_.snap_tolerance_m) return false;
      StepContext step = step_context(tolerance_m);
      Shell prepared = input.shell;
      if (rebuild.prepared) prepare(prepared, step);
      std::optional<Shell> shell = rebuild.reconstruct(prepared, {tolerance_m}, context_);
      if (!shell || shell->faces.empty()) continue;
      if (!fits(*shell, step).empty()) continue;
      result_.deviation = deviation_between(input.shell, *shell);
      result_.max_displacement_m = input.max_displacement_m;
      result_.repairs = std::move(step.repairs);
      result_.repairs.push_back(
          {std::string(rebuild.rung), building_.gml_id, result_.deviation.max_m});
      return deliver(std::string(rebuild.rung), std::move(*shell));
    }
    return false;
  }

  /// Whether the shell can be delivered, in the form that it gets here.
  std::vector<Issue> fits(Shell& shell, StepContext& step) {
    std::vector<GridPoint> cuts;
    std::vector<Issue> refused = make_fit(shell, options_.planarity_tolerance_m, gate_, cuts);
    for (const GridPoint& cut : cuts) step.note("face_split", cut);
    return refused;
  }

  StepContext step_context(double tolerance_m) const {
    return {tolerance_m,
            std::max(options_.planarity_tolerance_m, tolerance_m),
            options_.max_hole_area_m2,
            {},
            {},
            0};
  }

  std::vector<double> tolerances_m() const {
    std::vector<double> tolerances_m{options_.snap_tolerance_m};
    for (const double wider : kWiderTolerances_m)
      if (wider > options_.snap_tolerance_m && wider <= options_.max_displacement_m)
        tolerances_m.push_back(wider);
    return tolerances_m;
  }

  bool try_block(const Gridded& input, bool footprint_only) {
    if (!options_.block_on_failure) return false;
    const std::string reason = lod1_block(
        input.shell, footprint_only, number_attribute(building_.attributes, "measuredHeight"),
        [&](Shell& shell) {
          if (context_.stopped()) return true;
          StepContext step = step_context(options_.snap_tolerance_m);
          if (!fits(shell, step).empty()) return false;
          result_.deviation = deviation_between(input.shell, shell);
          result_.repairs = {{"replaced_by_block", building_.gml_id, result_.deviation.max_m}};
          return deliver("lod1_block", std::move(shell));
        });
    if (result_.rung.empty()) result_.reason = reason;
    return !result_.rung.empty();
  }

  bool deliver(std::string rung, Shell shell) {
    result_.rung = std::move(rung);
    result_.lane = lane_of(shell);
    result_.shell = std::move(shell);
    return true;
  }

  const Building& building_;
  const HealOptions& options_;
  const DeliveryGate& gate_;
  const RunContext& context_;
  Healed result_;
};

}  // namespace

void StepContext::note(std::string kind, std::string where, double displacement_m) {
  max_displacement_m = std::max(max_displacement_m, displacement_m);
  repairs.push_back({std::move(kind), std::move(where), displacement_m});
}

void StepContext::note(std::string kind, const GridPoint& at, double displacement_m) {
  note(std::move(kind), place_text(at), displacement_m);
  repairs.back().at = to_metres(at);
}

Healed heal(const Building& building, std::span<const Lod> lod, const HealOptions& options,
            const DeliveryGate& gate, const RunContext& context) {
  return Ladder(building, options, gate, context).climb(lod);
}

}  // namespace citymesh
