#include "core/validate/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "core/base/union_find.h"
#include "core/citymodel/grid.h"
#include "core/geometry/triangulation.h"
#include "core/validate/boundary.h"
#include "core/validate/findings.h"
#include "core/validate/polygons.h"
#include "core/validate/shells.h"
#include "core/validate/solids.h"

namespace citymesh {
namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers numbers_to(std::size_t count) {
  Numbers numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

/// Checks the shells of one solid; the first is the exterior.
std::optional<SolidBody> check_solid(std::vector<Boundary>& shells, std::string name,
                                     const ValidateOptions& options, Findings& findings) {
  bool sound = true;
  for (Boundary& shell : shells)
    sound = check_polygons(shell, options, findings) &&
            check_shell_level(shell, ShellKind::Closed, findings) && sound;
  if (!sound) return {};
  return check_solid_level(shells, std::move(name), findings);
}

class GeometryCheck {
 public:
  GeometryCheck(const Building& building, const Geometry& geometry, const ValidateOptions& options)
      : building_(building), geometry_(geometry), options_(options) {}

  Validated run() {
    if (geometry_.polygons.empty()) {
      findings_.add(902, [&] { return building_.gml_id; }, 0, {});
    } else if (place_on_grid()) {
      if (!geometry_.solids.empty() && !geometry_.footprint)
        check_solids();
      else
        check_surfaces();
    }
    result_.issues = findings_.take();
    if (geometry_.assembled && !geometry_.footprint)
      for (Issue& issue : result_.issues) issue.assembled = issue.code >= 300 && issue.code < 500;
    return std::move(result_);
  }

 private:
  bool place_on_grid() {
    points_.reserve(geometry_.points.size());
    for (const Point3& p : geometry_.points) {
      const auto on_grid = to_grid(p);
      if (!on_grid) {
        findings_.add(issue_code::kCoordinateOutOfRange,
                      [&] { return fmt::format("({} {} {})", p.x, p.y, p.z); }, p.x, {});
        return false;
      }
      points_.push_back(*on_grid);
    }
    return true;
  }

  Boundary boundary(const Numbers& polygons, std::string name) const {
    Boundary made =
        make_boundary(building_, geometry_, points_, polygons, options_.snap_tolerance_m);
    made.name = std::move(name);
    return made;
  }

  void check_surfaces() {
    std::vector<Boundary> shells;
    shells.push_back(boundary(numbers_to(geometry_.polygons.size()), ""));
    const bool shell = geometry_.assembled || geometry_.type == GeometryType::Solid;
    if (shell && !geometry_.footprint) {
      if (auto solid = check_solid(shells, building_.gml_id, options_, findings_))
        result_.solids.push_back(std::move(*solid));
    } else if (check_polygons(shells[0], options_, findings_)) {
      if (geometry_.footprint)
        check_footprint(shells[0]);
      else if (geometry_.type == GeometryType::CompositeSurface)
        check_shell_level(shells[0], ShellKind::Surface, findings_);
    }
    count(shells);
  }

  /// C119: areas are drawn as they are seen from above.
  void check_footprint(const Boundary& areas) {
    for (const TestedPolygon& polygon : areas.polygons)
      if (ring_normal(areas.points, polygon.rings[0]).z < 0)
        findings_.add(
            issue_code::kFootprintTurned, [&] { return areas.label(polygon); }, 0,
            to_metres(areas.points[polygon.rings[0][0]]));
  }

  void check_solids() {
    const bool several = geometry_.solids.size() > 1;
    for (std::size_t s = 0; s < geometry_.solids.size(); ++s) {
      const Solid& solid = geometry_.solids[s];
      const std::string of = several ? fmt::format("solid {}, ", s) : "";
      const bool has_cavities = !solid.interiors.empty();
      std::vector<Boundary> shells;
      shells.push_back(boundary(solid.exterior, of + (has_cavities ? "shell 0, " : "")));
      for (std::size_t i = 0; i < solid.interiors.size(); ++i)
        shells.push_back(boundary(solid.interiors[i], fmt::format("{}shell {}, ", of, i + 1)));
      const bool empty = std::any_of(shells.begin(), shells.end(),
                                     [](const Boundary& shell) { return shell.polygons.empty(); });
      std::string name =
          several ? fmt::format("{} solid {}", building_.gml_id, s) : building_.gml_id;
      if (empty)
        findings_.add(902, [&] { return name; }, 0, {});
      else if (auto body = check_solid(shells, name, options_, findings_))
        result_.solids.push_back(std::move(*body));
      count(shells);
    }
    if (geometry_.type == GeometryType::CompositeSolid &&
        result_.solids.size() == geometry_.solids.size())
      check_composite(result_.solids, findings_);
  }

  void count(const std::vector<Boundary>& shells) {
    for (const Boundary& shell : shells) result_.triangles += shell.triangles.size();
  }

  const Building& building_;
  const Geometry& geometry_;
  const ValidateOptions& options_;
  std::vector<GridPoint> points_;
  Findings findings_;
  Validated result_;
};

/// Faces of cavities by the pieces in which they hang together.
std::vector<Numbers> cavities_of(const Shell& shell) {
  UnionFind joined(shell.points.size());
  for (const Face& face : shell.faces)
    for (const Ring& ring : face.rings)
      for (const std::uint32_t corner : ring)
        if (face.cavity) joined.join(face.rings[0][0], corner);
  std::map<std::uint32_t, Numbers> pieces;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
    const Face& face = shell.faces[f];
    if (face.cavity && !face.rings.empty() && !face.rings[0].empty())
      pieces[joined.root(face.rings[0][0])].push_back(f);
  }
  std::vector<Numbers> cavities;
  cavities.reserve(pieces.size());
  for (auto& [root, faces] : pieces) cavities.push_back(std::move(faces));
  std::sort(cavities.begin(), cavities.end());
  return cavities;
}

}  // namespace

Validated validate(const Building& building, const Geometry& geometry,
                   const ValidateOptions& options) {
  return GeometryCheck(building, geometry, options).run();
}

std::vector<Issue> validate(const Shell& shell, const ValidateOptions& options) {
  Numbers outer;
  for (std::uint32_t f = 0; f < shell.faces.size(); ++f)
    if (!shell.faces[f].cavity) outer.push_back(f);
  std::vector<Boundary> shells;
  shells.push_back(make_boundary(shell, outer, options.snap_tolerance_m));
  for (const Numbers& cavity : cavities_of(shell)) {
    shells.push_back(make_boundary(shell, cavity, options.snap_tolerance_m));
    shells.back().name = fmt::format("shell {}, ", shells.size() - 1);
  }
  Findings findings;
  check_solid(shells, "", options, findings);
  return findings.take();
}

std::vector<bool> sound_faces(const Shell& shell, const ValidateOptions& options) {
  Boundary boundary;
  boundary.points = shell.points;
  for (const Face& face : shell.faces) {
    TestedPolygon& polygon = boundary.polygons.emplace_back();
    polygon.rings = face.rings;
  }
  return sound_polygons(boundary, options);
}

std::vector<Issue> validate_parts(std::span<const SolidBody* const> solids) {
  Findings findings;
  check_overlaps(solids, 601, findings);
  return findings.take();
}

}  // namespace citymesh
