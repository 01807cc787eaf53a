#include "core/reconstruct/wrap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

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
constexpr double kMaxSteps = 200'000;         ///< work limit, of one wrap
constexpr double kMinAlpha_m = 0.05;
constexpr double kOffsetShare = 1.0 / 20;  ///< of alpha
constexpr double kReach = 5;               ///< offsets that a plane may be away from its point
constexpr int kAttempts = 3;               ///< to find an alpha that neither walks in nor bridges
constexpr double kSolidShare = 0.5;        ///< of what roofs cover, below which a wrap is a sheet
constexpr double kSwollenShare = 1.15;   ///< of the columns under the roofs, above which it bridges
constexpr double kSheet = 1000;          ///< steps; what lies closer above each other is one layer
constexpr std::int64_t kColumns = 64;    ///< along either side of the box
constexpr double kMaxLayers = 30;        ///< triangles above each other, on average
constexpr double kMaxBoxes = 40;         ///< the same for their boxes
constexpr double kCoveredShare = 0.9;    ///< of the footprint that has a ground
constexpr double kSamePlane = 0.97;      ///< cosine
constexpr double kMinHeight_m = 0.0015;  ///< of triangles, above what the gates take

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
  std::array<GridPoint, 3> corners(std::uint32_t i) const {
    return corners_of(shell_.points, triangles_[i]);
  }
  const Point3& normal(std::uint32_t i) const { return normals_[i]; }
  const Face& face(std::uint32_t i) const { return shell_.faces[face_of_[i]]; }
  const std::vector<GridBox>& boxes() const { return boxes_; }
  const GridBox& box() const { return box_; }

  double box_area_m2() const {
    const Point3 d =
        to_metres({box_.max.x - box_.min.x, box_.max.y - box_.min.y, box_.max.z - box_.min.z});
    return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
  }

  /// What the triangles cover seen from above.
  std::vector<Area> covered() const {
    std::vector<Area> areas;
    for (const Triangle& t : triangles_) {
      Area area;
      for (const std::uint32_t v : t) area.exterior.push_back(project(shell_.points[v], Axis::Z));
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

/// What upright columns through a soup tell.
struct Columns {
  double footprint_m2 = 0;  ///< met by any
  double ground_m2 = 0;     ///< met low
  double volume_m3 = 0;  ///< from the lowest to the highest; from the bottom where only one is met
  double layers = 0;     ///< met, on average
  double boxes = 0;      ///< of triangles met, on average: how far searches among them branch out
};

/// Whether the upright line through p meets the triangle, and where.
std::optional<double> met(const GridPoint2& p, const std::array<GridPoint, 3>& corners) {
  std::array<double, 3> share{};  // of every corner, times the area
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const GridPoint2 a = project(corners[(i + 1) % 3], Axis::Z),
                     b = project(corners[(i + 2) % 3], Axis::Z);
    share[i] = static_cast<double>(area2(a, b, p));
    sum += share[i];
  }
  double z = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (sum == 0 || share[i] * sum < 0) return {};
    z += share[i] / sum * static_cast<double>(corners[i].z);
  }
  return z;
}

Columns columns_through(const Soup& soup, const BoxTree& tree) {
  Columns columns;
  const GridBox& box = soup.box();
  const std::int64_t wide = box.max.x - box.min.x, deep = box.max.y - box.min.y;
  const auto bottom = static_cast<double>(box.min.z);
  const double low = bottom + static_cast<double>(box.max.z - box.min.z) / 4;
  const double cell_m2 = static_cast<double>(wide) * static_cast<double>(deep) * kGridStep_m *
                         kGridStep_m / static_cast<double>(kColumns * kColumns);
  std::uint64_t hits = 0, boxes = 0, columns_met = 0;
  for (std::int64_t i = 0; i < kColumns; ++i)
    for (std::int64_t j = 0; j < kColumns; ++j) {
      const GridPoint2 p{box.min.x + (2 * i + 1) * wide / (2 * kColumns),
                         box.min.y + (2 * j + 1) * deep / (2 * kColumns)};
      double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
      const std::uint64_t hits_before = hits;
      tree.for_each_meeting(GridBox{{p.x, p.y, box.min.z}, {p.x, p.y, box.max.z}},
                            [&](std::uint32_t t) {
                              ++boxes;
                              const auto z = met(p, soup.corners(t));
                              if (!z) return;
                              lowest = std::min(lowest, *z);
                              highest = std::max(highest, *z);
                              ++hits;
                            });
      if (hits == hits_before) continue;
      ++columns_met;
      columns.footprint_m2 += cell_m2;
      if (lowest <= low) columns.ground_m2 += cell_m2;
      const double from = highest - lowest > kSheet ? lowest : bottom;
      columns.volume_m3 += cell_m2 * (highest - from) * kGridStep_m;
    }
  if (columns_met > 0) {
    columns.layers = static_cast<double>(hits) / static_cast<double>(columns_met);
    columns.boxes = static_cast<double>(boxes) / static_cast<double>(columns_met);
  }
  return columns;
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
      const auto c = soup_.corners(i);
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
      const auto c = soup_.corners(i);
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
  const std::vector<GridBox> boxes = boxes_of(points, triangles);
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
  const BoxTree tree(soup.boxes());
  const Columns columns = columns_through(soup, tree);
  if (columns.footprint_m2 <= 0 || columns.layers > kMaxLayers || columns.boxes > kMaxBoxes ||
      context.stopped())
    return {};

  std::vector<GridPoint> points = clean.points;
  std::vector<Triangle> triangles = soup.triangles();
  if (columns.ground_m2 < kCoveredShare * columns.footprint_m2)
    add_ground(points, triangles, soup.covered(), box.min.z);
  const double expected_m3 =
      columns.footprint_m2 * std::max(soup.mean_z_m() - to_metres(box.min).z,
                                      static_cast<double>(height) * kGridStep_m / 4);

  std::vector<Point3> places;
  places.reserve(points.size());
  for (const GridPoint& p : points) places.push_back(to_metres(p));
  const Planes planes(soup, tree);
  double alpha_m = std::max(kMinAlpha_m, std::sqrt(soup.box_area_m2() / kBalls)) *
                   (1 + 20 * options.tolerance_m);
  const auto max_steps = static_cast<std::size_t>(
      kMaxSteps * std::min(1.0, kMaxLayers / std::max(columns.boxes, 1.0)));
  bool bridges = false, walks_in = false;
  for (int attempt = 0; attempt < kAttempts && !(bridges && walks_in); ++attempt) {
    const double offset_m = alpha_m * kOffsetShare, reach_m = kReach * offset_m;
    const auto mesh = alpha_wrap(places, triangles, alpha_m, offset_m, {max_steps, context.stop});
    if (context.stopped()) return {};
    std::vector<GridPoint> fitted;
    if (mesh) fitted = refitted(*mesh, planes, reach_m);
    const double fitted_m3 = mesh ? volume_m3(fitted, mesh->triangles) : 0;
    if (fitted_m3 > kSwollenShare * columns.volume_m3) {
      if (std::exchange(bridges, true)) return {};
      alpha_m /= 2;
    } else if (fitted_m3 < kSolidShare * expected_m3) {
      walks_in = true;
      alpha_m *= 2;
    } else {
      return shell_of(*mesh, fitted, soup, planes, reach_m);
    }
  }
  return {};
}

}  // namespace citymesh
