#include "core/reconstruct/wrap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/box_tree.h"
#include "core/geometry/measure.h"
#include "core/geometry/overlay.h"
#include "core/reconstruct/alpha_wrap.h"
#include "core/reconstruct/roles.h"
#include "core/reconstruct/sheets.h"

namespace citymesh {
namespace {

constexpr std::size_t kMaxTriangles = 60000;  ///< work limit, of the input
constexpr double kBalls = 2500;               ///< work limit: area of the box by alpha²
constexpr double kMinAlpha_m = 0.05;
constexpr double kOffsetShare = 1.0 / 20;  ///< of alpha
constexpr double kReach = 5;               ///< offsets that a plane may be away from its point
constexpr int kGrowths = 3;                ///< times that alpha is doubled when the wrap walks in
constexpr double kSolidShare = 0.5;        ///< of what roofs cover, below which a wrap is a sheet
constexpr double kCoveredShare = 0.9;      ///< of the footprint that has a ground
constexpr double kSamePlane = 0.97;        ///< cosine
constexpr double kMinHeight_m = 0.0015;    ///< of triangles, above what the gates take

double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

GridPoint to_grid(const Point3& p) {
  return {std::llround(p.x * kGridStepsPerMetre), std::llround(p.y * kGridStepsPerMetre),
          std::llround(p.z * kGridStepsPerMetre)};
}

std::array<GridPoint, 3> corners_of(std::span<const GridPoint> points, const Triangle& t) {
  return {points[t[0]], points[t[1]], points[t[2]]};
}

/// The triangles of the input and what they tell of the size of the building.
class Soup {
 public:
  explicit Soup(const Shell& shell) : shell_(shell) {
    for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
      if (role_of(shell, shell.faces[f], 0) == FaceRole::Ignored) continue;
      for (const Triangle& t : sheet_of(shell, shell.faces[f])) {
        const Point3 n = normal_of(shell.points[t[0]], shell.points[t[1]], shell.points[t[2]]);
        const double length = std::sqrt(dot(n, n));
        if (length == 0) continue;
        triangles_.push_back(t);
        face_of_.push_back(f);
        normals_.push_back({n.x / length, n.y / length, n.z / length});
        const GridBox box = box_of(shell.points, t);
        boxes_.push_back(box);
        if (triangles_.size() == 1) box_ = box;
        box_.add(box);
      }
    }
  }

  const Shell& shell() const { return shell_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const Point3& normal(std::uint32_t i) const { return normals_[i]; }
  const Face& face(std::uint32_t i) const { return shell_.faces[face_of_[i]]; }
  const std::vector<GridBox>& boxes() const { return boxes_; }
  const GridBox& box() const { return box_; }

  double box_area_m2() const {
    const Point3 d =
        to_metres({box_.max.x - box_.min.x, box_.max.y - box_.min.y, box_.max.z - box_.min.z});
    return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
  }

  /// What of the triangles within `z_below` of the lowest point, or all, covers seen from above.
  std::vector<Area> covered(std::int64_t z_below) const {
    std::vector<Area> areas;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (boxes_[i].max.z > z_below) continue;
      Area area;
      for (const std::uint32_t v : triangles_[i])
        area.exterior.push_back(project(shell_.points[v], Axis::Z));
      const Int128 twice = area2(area);
      if (twice == 0) continue;
      if (twice < 0) std::swap(area.exterior[1], area.exterior[2]);
      areas.push_back(std::move(area));
    }
    auto united = unite(areas);
    return united ? std::move(*united) : std::vector<Area>{};
  }

  /// Mean height of what is not vertical, weighed by what it covers.
  double mean_z_m() const {
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Triangle& t = triangles_[i];
      const double area = area_m2(shell_.points, std::span(&t, 1)) * std::abs(normals_[i].z);
      const auto z = static_cast<double>(shell_.points[t[0]].z + shell_.points[t[1]].z +
                                         shell_.points[t[2]].z);
      sum += area * z / 3 * kGridStep_m;
      weight += area;
    }
    return weight > 0 ? sum / weight : 0;
  }

 private:
  const Shell& shell_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> face_of_;
  std::vector<Point3> normals_;
  std::vector<GridBox> boxes_;
  GridBox box_{};
};

double area_m2(const std::vector<Area>& areas) {
  double sum = 0;
  for (const Area& area : areas) sum += static_cast<double>(area2(area)) / 2;
  return sum / (kGridStepsPerMetre * kGridStepsPerMetre);
}

/// A sheet over the areas at the height z.
void add_ground(std::vector<GridPoint>& points, std::vector<Triangle>& triangles,
                const std::vector<Area>& areas, std::int64_t z) {
  for (const Area& area : areas) {
    Shell sheet;
    Face face;
    const auto add = [&](const std::vector<GridPoint2>& ring) {
      Ring corners;
      for (const GridPoint2& p : ring) {
        corners.push_back(static_cast<std::uint32_t>(sheet.points.size()));
        sheet.points.push_back({p.x, p.y, z});
      }
      face.rings.push_back(std::move(corners));
    };
    add(area.exterior);
    for (const auto& hole : area.holes) add(hole);
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), sheet.points.begin(), sheet.points.end());
    for (const Triangle& t : sheet_of(sheet, face))
      triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

/// The planes of the input around a place.
class Planes {
 public:
  Planes(const Soup& soup, const BoxTree& tree) : soup_(soup), tree_(tree) {}

  /// The nearest point to p on the nearest planes within reach, at most `count` that are not
  /// parallel.
  Point3 fitted(const Point3& p, double reach_m, std::size_t count) const {
    const GridPoint at = to_grid(p);
    const auto reach = static_cast<std::int64_t>(std::ceil(reach_m * kGridStepsPerMetre));
    std::vector<std::pair<double, std::uint32_t>> near;
    tree_.for_each_meeting(GridBox::of(at).grown(reach), [&](std::uint32_t i) {
      const auto c = corners_of(soup_.shell().points, soup_.triangles()[i]);
      const double d = distance_to_triangle_m(at, c[0], c[1], c[2]);
      if (d <= reach_m) near.emplace_back(d, i);
    });
    std::sort(near.begin(), near.end());
    std::vector<std::uint32_t> planes;
    for (const auto& [d, i] : near) {
      if (planes.size() == count) break;
      if (std::all_of(planes.begin(), planes.end(), [&, i = i](std::uint32_t j) {
            return std::abs(dot(soup_.normal(i), soup_.normal(j))) < kSamePlane;
          }))
        planes.push_back(i);
    }
    // Projecting onto one plane after the other ends on their intersection.
    Point3 x = p;
    constexpr int kSweeps = 60;
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (const std::uint32_t i : planes) {
        const Point3 q = to_metres(soup_.shell().points[soup_.triangles()[i][0]]);
        const Point3& n = soup_.normal(i);
        const double d = dot(n, {x.x - q.x, x.y - q.y, x.z - q.z});
        x = {x.x - d * n.x, x.y - d * n.y, x.z - d * n.z};
      }
    return std::hypot(x.x - p.x, x.y - p.y, x.z - p.z) <= 2 * reach_m ? x : p;
  }

  /// Face of the input that a triangle of the result continues.
  const Face* source(const Point3& centre, const Point3& normal, double reach_m) const {
    const GridPoint at = to_grid(centre);
    const auto reach = static_cast<std::int64_t>(std::ceil(reach_m * kGridStepsPerMetre));
    double nearest = reach_m;
    const Face* found = nullptr;
    tree_.for_each_meeting(GridBox::of(at).grown(reach), [&](std::uint32_t i) {
      if (std::abs(dot(soup_.normal(i), normal)) < 0.7) return;
      const auto c = corners_of(soup_.shell().points, soup_.triangles()[i]);
      const double d = distance_to_triangle_m(at, c[0], c[1], c[2]);
      if (d > nearest || (found != nullptr && d == nearest)) return;
      nearest = d;
      found = &soup_.face(i);
    });
    return found;
  }

 private:
  const Soup& soup_;
  const BoxTree& tree_;
};

bool is_flat(std::span<const GridPoint> points, const Triangle& t) {
  const auto c = corners_of(points, t);
  const double longest =
      std::max({distance_m(c[0], c[1]), distance_m(c[1], c[2]), distance_m(c[2], c[0])});
  return longest <= 0 || 2 * area_m2(points, std::span(&t, 1)) / longest < kMinHeight_m;
}

/// Groups of points that spoil something: of a flat triangle, or of two that cross.
std::vector<std::vector<std::uint32_t>> spoiled(std::span<const GridPoint> points,
                                                std::span<const Triangle> triangles) {
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<GridBox> boxes;
  for (const Triangle& t : triangles) boxes.push_back(box_of(points, t));
  const BoxTree tree(boxes);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& s = triangles[i];
    if (is_flat(points, s)) {
      groups.emplace_back(s.begin(), s.end());
      continue;
    }
    tree.for_each_meeting(boxes[i], [&](std::uint32_t j) {
      const Triangle& t = triangles[j];
      if (j <= i || is_flat(points, t)) return;
      if (!triangles_clash(corners_of(points, s), corners_of(points, t))) return;
      groups.emplace_back(s.begin(), s.end());
      groups.back().insert(groups.back().end(), t.begin(), t.end());
    });
  }
  return groups;
}

/// Moves points onto the planes they belong to. Where that spoils something, the one that moved
/// farthest goes to its nearest plane only, and then back to where the wrap had it.
std::vector<GridPoint> refitted(const WrapMesh& mesh, const Planes& planes, double reach_m) {
  constexpr std::array<std::size_t, 3> kPlanes{3, 1, 0};
  std::vector<std::array<GridPoint, kPlanes.size()>> choices;
  std::vector<GridPoint> points;
  std::vector<std::size_t> choice(mesh.points.size(), 0);
  for (const Point3& p : mesh.points) {
    auto& own = choices.emplace_back();
    for (std::size_t k = 0; k < kPlanes.size(); ++k)
      own[k] = to_grid(planes.fitted(p, reach_m, kPlanes[k]));
    points.push_back(own[0]);
  }
  constexpr int kRounds = 40;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<char> steps_back(points.size(), 0);
    for (const auto& group : spoiled(points, mesh.triangles)) {
      std::optional<std::uint32_t> farthest;
      double most_m = -1;
      for (const std::uint32_t v : group) {
        if (choice[v] + 1 == kPlanes.size()) continue;
        const double moved_m = distance_m(points[v], choices[v].back());
        if (moved_m <= most_m) continue;
        most_m = moved_m;
        farthest = v;
      }
      if (farthest) steps_back[*farthest] = 1;
    }
    bool changed = false;
    for (std::size_t v = 0; v < points.size(); ++v) {
      if (!steps_back[v]) continue;
      points[v] = choices[v][++choice[v]];
      changed = true;
    }
    if (!changed) break;
  }
  return points;
}

Shell shell_of(const WrapMesh& mesh, const std::vector<GridPoint>& points, const Soup& soup,
               const Planes& planes, double reach_m) {
  Shell shell;
  shell.points = points;
  shell.surface_ids = soup.shell().surface_ids;
  for (const Triangle& t : mesh.triangles) {
    Face face;
    face.rings = {{t[0], t[1], t[2]}};
    const auto c = corners_of(points, t);
    Point3 n = normal_of(c[0], c[1], c[2]);
    const double length = std::sqrt(dot(n, n));
    if (length > 0) n = {n.x / length, n.y / length, n.z / length};
    const Point3 a = to_metres(c[0]), b = to_metres(c[1]), d = to_metres(c[2]);
    const Point3 centre{(a.x + b.x + d.x) / 3, (a.y + b.y + d.y) / 3, (a.z + b.z + d.z) / 3};
    if (const Face* from = planes.source(centre, n, reach_m)) {
      face.type = from->type;
      face.source = from->source;
    } else {
      face.added = true;
    }
    shell.faces.push_back(std::move(face));
  }
  return shell;
}

}  // namespace

std::optional<Shell> wrap(const Shell& input, const ReconstructOptions& options,
                          const RunContext& context) {
  const Shell clean = with_clean_rings(input);
  const Soup soup(clean);
  if (soup.triangles().empty() || soup.triangles().size() > kMaxTriangles) return {};
  const GridBox& box = soup.box();
  const std::int64_t height = box.max.z - box.min.z;
  if (height == 0) return {};
  const std::vector<Area> footprint = soup.covered(box.max.z);
  const double footprint_m2 = area_m2(footprint);
  if (footprint_m2 <= 0) return {};

  std::vector<GridPoint> points = clean.points;
  std::vector<Triangle> triangles = soup.triangles();
  if (area_m2(soup.covered(box.min.z + height / 4)) < kCoveredShare * footprint_m2)
    add_ground(points, triangles, footprint, box.min.z);
  const double expected_m3 = footprint_m2 * std::max(soup.mean_z_m() - to_metres(box.min).z,
                                                     static_cast<double>(height) * kGridStep_m / 4);

  std::vector<Point3> places;
  for (const GridPoint& p : points) places.push_back(to_metres(p));
  const BoxTree tree(soup.boxes());
  const Planes planes(soup, tree);
  double alpha_m = std::max(kMinAlpha_m, std::sqrt(soup.box_area_m2() / kBalls)) *
                   (1 + 20 * options.tolerance_m);
  for (int growth = 0; growth < kGrowths; ++growth, alpha_m *= 2) {
    if (context.stopped()) return {};
    const double offset_m = alpha_m * kOffsetShare;
    const auto mesh = alpha_wrap(places, triangles, alpha_m, offset_m);
    if (!mesh) continue;
    const double reach_m = kReach * offset_m;
    const std::vector<GridPoint> fitted = refitted(*mesh, planes, reach_m);
    if (volume_m3(fitted, mesh->triangles) < kSolidShare * expected_m3) continue;
    return shell_of(*mesh, fitted, soup, planes, reach_m);
  }
  return {};
}

}  // namespace citymesh
