#include "core/reconstruct/level.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/triangulation.h"

namespace citymesh {
namespace {

/// How far above and below a face its plane is believed.
constexpr std::int64_t kExtrapolation = 10000;
constexpr double kFlatness = 100;  ///< corners this close to a plane lie in it

std::optional<Slope> through(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const Point3 n = normal_of(a, b, c);
  if (n.z == 0) return {};
  return Slope{{a.x, a.y}, static_cast<double>(a.z), -n.x / n.z, -n.y / n.z};
}

}  // namespace

Level::Level(const Shell& shell, const Face& face) {
  for (const Ring& ring : face.rings) {
    const auto first = static_cast<std::uint32_t>(corners_.size());
    const auto n = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      corners_.push_back(shell.points[ring[i]]);
      edges_.emplace_back(first + i, first + (i + 1) % n);
    }
  }
  if (const auto triangles = triangulate(shell.points, face.rings)) {
    for (const Triangle& t : *triangles) {
      for (const std::uint32_t i : t) corners_.push_back(shell.points[i]);
      const auto k = static_cast<std::uint32_t>(corners_.size());
      triangles_.push_back({k - 3, k - 2, k - 1});
    }
  }
  lowest_ = highest_ = corners_[0].z;
  Point3 mean{};
  for (const GridPoint& p : corners_) {
    lowest_ = std::min(lowest_, p.z);
    highest_ = std::max(highest_, p.z);
  }
  const auto n = static_cast<double>(face.rings[0].size());
  for (std::size_t i = 0; i < face.rings[0].size(); ++i) {
    mean.x += static_cast<double>(corners_[i].x - corners_[0].x) / n;
    mean.y += static_cast<double>(corners_[i].y - corners_[0].y) / n;
    mean.z += static_cast<double>(corners_[i].z - corners_[0].z) / n;
  }
  const Point3 normal = ring_normal(shell.points, face.rings[0]);
  plane_.at = {corners_[0].x, corners_[0].y};
  if (triangles_.empty()) {  // a ring that crosses itself has no useful normal
    std::vector<Sounding> soundings;
    soundings.reserve(corners_.size());
    for (const GridPoint& p : corners_) soundings.push_back({project(p, Axis::Z), {p.z}});
    if (const auto plane = consensus(soundings, kFlatness, 0)) {
      plane_ = *plane;
      return;
    }
  }
  if (normal.z != 0) {
    plane_.gx = -normal.x / normal.z;
    plane_.gy = -normal.y / normal.z;
  }
  plane_.z0 = static_cast<double>(corners_[0].z) + mean.z - plane_.gx * mean.x - plane_.gy * mean.y;
}

std::int64_t Level::z(const GridPoint2& p, double reach_steps) const {
  const auto x = static_cast<double>(p.x), y = static_cast<double>(p.y);
  if (corners_.empty()) return std::llround(plane_.z(x, y));
  double nearest = reach_steps;
  std::optional<double> found;
  for (const auto& [i, j] : edges_) {
    const GridPoint &a = corners_[i], &b = corners_[j];
    const auto dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
    const double px = x - static_cast<double>(a.x), py = y - static_cast<double>(a.y);
    const double squared = dx * dx + dy * dy;
    const double t = squared > 0 ? std::clamp((px * dx + py * dy) / squared, 0.0, 1.0) : 0.0;
    const double d = std::hypot(px - t * dx, py - t * dy);
    if (d > nearest) continue;
    nearest = d;
    found = static_cast<double>(a.z) + t * static_cast<double>(b.z - a.z);
  }
  if (found) return std::llround(*found);
  for (const Triangle& t : triangles_) {
    const GridPoint &a = corners_[t[0]], &b = corners_[t[1]], &c = corners_[t[2]];
    const int u = orient2d(project(a, Axis::Z), project(b, Axis::Z), p),
              v = orient2d(project(b, Axis::Z), project(c, Axis::Z), p),
              w = orient2d(project(c, Axis::Z), project(a, Axis::Z), p);
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) continue;
    if (const auto plane = through(a, b, c)) return std::llround(plane->z(x, y));
  }
  return std::clamp(std::llround(plane_.z(x, y)), static_cast<long long>(lowest_ - kExtrapolation),
                    static_cast<long long>(highest_ + kExtrapolation));
}

std::optional<Slope> consensus(std::span<const Sounding> soundings, double tolerance_steps,
                               double share) {
  constexpr std::size_t kSeeds = 16;  ///< places that planes are laid through
  constexpr std::size_t kHeights = 6;
  if (soundings.size() < 3) return {};
  std::vector<GridPoint> seeds;
  std::vector<std::size_t> owner;
  const std::size_t stride = (soundings.size() + kSeeds - 1) / kSeeds;
  for (std::size_t i = 0; i < soundings.size(); i += stride)
    for (std::size_t k = 0; k < std::min(kHeights, soundings[i].z.size()); ++k) {
      seeds.push_back({soundings[i].at.x, soundings[i].at.y, soundings[i].z[k]});
      owner.push_back(i);
    }
  std::optional<Slope> best;
  std::pair<std::size_t, double> best_score{0, 0};  // soundings met, flatness
  for (std::size_t i = 0; i < seeds.size(); ++i)
    for (std::size_t j = i + 1; j < seeds.size(); ++j)
      for (std::size_t k = j + 1; k < seeds.size(); ++k) {
        if (owner[i] == owner[j] || owner[j] == owner[k]) continue;
        const Point3 n = normal_of(seeds[i], seeds[j], seeds[k]);
        const double steepness = std::hypot(n.x, n.y);
        if (std::abs(n.z) < 0.1 * steepness || n.z == 0) continue;
        const auto plane = through(seeds[i], seeds[j], seeds[k]);
        std::size_t met = 0;
        for (const Sounding& s : soundings) {
          const double z = plane->z(static_cast<double>(s.at.x), static_cast<double>(s.at.y));
          met += std::any_of(s.z.begin(), s.z.end(), [&](std::int64_t known) {
            return std::abs(static_cast<double>(known) - z) <= tolerance_steps;
          });
        }
        const std::pair score{met, -steepness / std::abs(n.z)};
        if (best && score <= best_score) continue;
        best_score = score;
        best = plane;
      }
  if (static_cast<double>(best_score.first) < share * static_cast<double>(soundings.size()))
    return {};
  return best;
}

}  // namespace citymesh
