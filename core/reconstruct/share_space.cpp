#include "core/reconstruct/share_space.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "core/geometry/cells.h"
#include "core/reconstruct/boundary.h"
#include "core/reconstruct/cut_faces.h"

namespace citymesh {
namespace {

constexpr std::uint32_t kNobody = ~0u;

/// Of closed bodies cuts become fewer from round to round; where they do not, nearly coinciding
/// walls never come to an end, and it is better to know soon.
std::uint64_t max_cuts(const Shell& input) { return 600 + input.faces.size(); }

/// Six times the volume, in steps³ from an own origin: differences decide, not the unit.
double volume_of(const std::vector<GridPoint>& points, const Triangle& t, const GridPoint& origin) {
  const auto from = [&](std::uint32_t i) {
    return Point3{static_cast<double>(points[i].x - origin.x),
                  static_cast<double>(points[i].y - origin.y),
                  static_cast<double>(points[i].z - origin.z)};
  };
  const Point3 a = from(t[0]), b = from(t[1]), c = from(t[2]);
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
         a.z * (b.x * c.y - b.y * c.x);
}

class Sharing {
 public:
  Sharing(std::span<const Shell> bodies, const Shell& all, const CutFaces& cut)
      : bodies_(bodies),
        all_(all),
        cut_(cut),
        arrangement_(cut.arrangement),
        owner_front_(arrangement_.facets.size(), kNobody),
        owner_back_(arrangement_.facets.size(), kNobody) {
    std::uint32_t first = 0;
    for (const Shell& body : bodies) {
      first_face_.push_back(first);
      first += static_cast<std::uint32_t>(body.faces.size());
    }
    first_face_.push_back(first);
  }

  /// Gives every place to one body; returns what others lose by that.
  std::vector<SharedSpace> give_out() {
    const Cells cells(arrangement_);
    std::vector<Inside> inside;
    for (std::uint32_t body = 0; body < bodies_.size(); ++body)
      inside.push_back(inside_of(body, cells));
    std::vector<SharedSpace> spaces;
    for (const std::uint32_t body : order(inside)) {
      std::map<std::uint32_t, std::uint32_t> losses;  // to whom, at which facet
      const auto take = [&](char is_in, std::uint32_t& owner, std::uint32_t f) {
        if (!is_in) return;
        if (owner == kNobody)
          owner = body;
        else
          losses.try_emplace(owner, f);
      };
      for (std::uint32_t f = 0; f < arrangement_.facets.size(); ++f) {
        take(inside[body].front[f], owner_front_[f], f);
        take(inside[body].back[f], owner_back_[f], f);
      }
      for (const auto& [to, facet] : losses)
        spaces.push_back(
            {body, to,
             volume_between(
                 [&](std::size_t f) { return inside[body].front[f] && owner_front_[f] == to; },
                 [&](std::size_t f) { return inside[body].back[f] && owner_back_[f] == to; }),
             arrangement_.points[arrangement_.facets[facet][0]]});
    }
    std::sort(spaces.begin(), spaces.end(), [](const SharedSpace& s, const SharedSpace& t) {
      return s.from != t.from ? s.from < t.from : s.to < t.to;
    });
    return spaces;
  }

  /// The boundary of what a body has.
  Shell shell_of(std::uint32_t body) const {
    SolidBoundary boundary;
    std::vector<std::uint32_t> number(arrangement_.points.size(), kNobody);
    const std::uint32_t first_face = first_face_[body], end_face = first_face_[body + 1];
    for (std::uint32_t f = 0; f < arrangement_.facets.size(); ++f) {
      const bool front = owner_front_[f] == body, back = owner_back_[f] == body;
      if (front == back) continue;
      Triangle t = arrangement_.facets[f];
      if (front) std::swap(t[1], t[2]);
      for (std::uint32_t& corner : t) {
        if (number[corner] == kNobody) {
          number[corner] = static_cast<std::uint32_t>(boundary.points.size());
          boundary.points.push_back(arrangement_.points[corner]);
        }
        corner = number[corner];
      }
      std::vector<Cover> own;
      for (const Cover& cover : arrangement_.covers[f])
        if (body_of(cut_.face_of[cover.input]) == body) own.push_back(cover);
      // A new face is one for each face of the others that it follows.
      const std::uint32_t parent =
          own.empty() ? end_face + parent_of(arrangement_.covers[f], back, cut_.face_of, all_)
                      : parent_of(own, back, cut_.face_of, all_);
      boundary.triangles.push_back(t);
      boundary.parents.push_back(parent - first_face);
      boundary.shared.push_back((front ? owner_back_[f] : owner_front_[f]) != kNobody);
    }
    if (boundary.triangles.empty()) return {};
    separate_contacts(boundary, kContactGap_m);
    return citymesh::shell_of(boundary, bodies_[body]);
  }

 private:
  std::uint32_t body_of(std::uint32_t face) const {
    return static_cast<std::uint32_t>(
        std::upper_bound(first_face_.begin(), first_face_.end(), face) - first_face_.begin() - 1);
  }

  /// Whether a body has space on either side of each facet.
  struct Inside {
    std::vector<char> front, back;
  };

  Inside inside_of(std::uint32_t body, const Cells& cells) const {
    std::vector<std::int8_t> weights(cut_.face_of.size(), 0);
    for (std::size_t t = 0; t < weights.size(); ++t)
      weights[t] = body_of(cut_.face_of[t]) == body ? 1 : 0;
    const WindingNumbers winding = cells.winding(weights);
    Inside inside;
    for (std::size_t f = 0; f < winding.front.size(); ++f) {
      inside.front.push_back(is_inside(winding.front[f]));
      inside.back.push_back(is_inside(winding.back[f]));
    }
    return inside;
  }

  /// Bodies in the order in which they choose: the smallest first.
  std::vector<std::uint32_t> order(const std::vector<Inside>& inside) const {
    std::vector<double> volume;
    volume.reserve(inside.size());
    for (const Inside& body : inside)
      volume.push_back(volume_between([&](std::size_t f) { return body.front[f]; },
                                      [&](std::size_t f) { return body.back[f]; }));
    std::vector<std::uint32_t> order(bodies_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return volume[a] < volume[b]; });
    return order;
  }

  /// Volume (m³) of the space that has the facets' given sides.
  template <class Front, class Back>
  double volume_between(Front&& front, Back&& back) const {
    double volume = 0;
    for (std::size_t f = 0; f < arrangement_.facets.size(); ++f)
      if (const int sign = (back(f) ? 1 : 0) - (front(f) ? 1 : 0); sign != 0)
        volume +=
            sign * volume_of(arrangement_.points, arrangement_.facets[f], arrangement_.points[0]);
    constexpr double kSixth_m3 = kGridStep_m * kGridStep_m * kGridStep_m / 6;
    return volume * kSixth_m3;
  }

  std::span<const Shell> bodies_;
  const Shell& all_;
  const CutFaces& cut_;
  const Arrangement& arrangement_;
  std::vector<std::uint32_t> first_face_;  ///< of each body among all; one more at the end
  std::vector<std::uint32_t> owner_front_, owner_back_;
};

}  // namespace

std::optional<SharedOut> share_space(std::span<const Shell> bodies,
                                     const ReconstructOptions& options, const RunContext& context) {
  const Shell all = joined(bodies);
  const auto cut = cut_faces(all, options.tolerance_m, max_cuts(all), context);
  if (!cut || cut->arrangement.facets.empty()) return {};
  Sharing sharing(bodies, all, *cut);
  SharedOut out;
  out.spaces = sharing.give_out();
  for (std::uint32_t body = 0; body < bodies.size(); ++body)
    out.bodies.push_back(sharing.shell_of(body));
  return out;
}

std::optional<std::vector<SharedSpace>> shared_space(std::span<const Shell> bodies,
                                                     const ReconstructOptions& options,
                                                     const RunContext& context) {
  const Shell all = joined(bodies);
  const auto cut = cut_faces(all, options.tolerance_m, max_cuts(all), context);
  if (!cut || cut->arrangement.facets.empty()) return {};
  return Sharing(bodies, all, *cut).give_out();
}

}  // namespace citymesh
