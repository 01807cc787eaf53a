#include "core/source/frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace citymesh::source {
namespace {

// No city lies further south or north.
constexpr double kSouthernmost_deg = -60, kNorthernmost_deg = 80;
// Data may reach a little beyond the official area of use.
constexpr double kAreaMargin_deg = 1.0;
bool plausible_place(const CrsFacts& facts, double longitude_deg, double latitude_deg) {
  if (!(latitude_deg >= kSouthernmost_deg && latitude_deg <= kNorthernmost_deg)) return false;
  if (!(std::abs(longitude_deg) <= 360)) return false;
  const Box3& area = facts.area_of_use_deg;
  if (area.is_empty()) return true;
  if (latitude_deg < area.min.y - kAreaMargin_deg || latitude_deg > area.max.y + kAreaMargin_deg)
    return false;
  for (const double turn : {0.0, 360.0, -360.0})
    if (longitude_deg + turn >= area.min.x - kAreaMargin_deg &&
        longitude_deg + turn <= area.max.x + kAreaMargin_deg)
      return true;
  return false;
}

bool plausible(const Crs& crs, const CrsFacts& facts, Point3 centre, CrsBook& book) {
  if (facts.geographic) return plausible_place(facts, centre.x, centre.y);
  const auto& to_degrees = book.to_degrees(crs);
  std::array<Point3, 1> place{centre};
  if (!to_degrees || !to_degrees->apply(place)) return false;
  return plausible_place(facts, place[0].x, place[0].y);
}

Point3 centre_of(const Box3& box) {
  return {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, (box.min.z + box.max.z) / 2};
}

}  // namespace

const Result<CrsFacts>& CrsBook::facts(const Crs& crs) {
  const auto found = facts_.find(crs.id);
  if (found != facts_.end()) return found->second;
  return facts_.emplace(crs.id, describe_crs(crs)).first->second;
}

const Result<Transformer>& CrsBook::transformer(const Crs& from, const Crs& to) {
  const std::pair key{from.id, to.id};
  const auto found = transformers_.find(key);
  if (found != transformers_.end()) return found->second;
  return transformers_.emplace(key, Transformer::create(from, to)).first->second;
}

const Result<Transformer>& CrsBook::to_degrees(const Crs& crs) {
  const auto found = to_degrees_.find(crs.id);
  if (found != to_degrees_.end()) return found->second;
  return to_degrees_.emplace(crs.id, Transformer::to_degrees(crs)).first->second;
}

Box3 with_axes_swapped(Box3 box) {
  std::swap(box.min.x, box.min.y);
  std::swap(box.max.x, box.max.y);
  return box;
}

std::vector<SrsUse> interpret_srs(const FileRecord& file, const Crs& assumed, AxisOrder order,
                                  CrsBook& book) {
  std::vector<SrsUse> uses(file.facts.srs_names.size());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    SrsUse& use = uses[i];
    const std::string& name = file.facts.srs_names[i];
    auto parsed = name.empty() ? Result<Crs>(assumed) : parse_crs(name);
    if (!parsed) {
      use.problem = parsed.error().message;
      continue;
    }
    use.crs = *parsed;
    std::optional<CrsFacts> facts;
    if (use.crs.known()) {
      const auto& described = book.facts(use.crs);
      if (!described) {
        use.problem = described.error().message;
        continue;
      }
      facts = *described;
    }

    const bool geographic = facts && facts->geographic;
    use.extent = geographic ? file.srs[i].near_deg : file.srs[i].near_m;
    if (order == AxisOrder::NorthEast) {
      use.swap_axes = true;
      use.extent = with_axes_swapped(use.extent);
    }
    if (!facts || order != AxisOrder::Auto) continue;

    use.swap_axes = geographic && facts->north_first;
    const Box3 seen = !use.extent.is_empty()         ? use.extent
                      : i == file.facts.declared_srs ? file.facts.declared_extent
                                                     : Box3{};
    if (!seen.is_empty()) {
      const Point3 as_stored = centre_of(seen);
      const Point3 swapped{as_stored.y, as_stored.x, as_stored.z};
      const bool stated_fits =
          plausible(use.crs, *facts, use.swap_axes ? swapped : as_stored, book);
      if (!stated_fits && plausible(use.crs, *facts, use.swap_axes ? as_stored : swapped, book))
        use.swap_axes = !use.swap_axes;
    }
    if (use.swap_axes && !use.extent.is_empty()) use.extent = with_axes_swapped(use.extent);
  }
  return uses;
}

Result<std::vector<Ring2>> rings_of(const RequestBox& box, const Transformer* transformer) {
  std::vector<std::vector<Point3>> rings;
  if (box.rings.empty())
    rings.push_back(densified_ring(box.min_x, box.min_y, box.max_x, box.max_y));
  const double step = std::max(box.max_x - box.min_x, box.max_y - box.min_y) / (kPointsPerSide - 1);
  for (const auto& corners : box.rings) {
    auto& ring = rings.emplace_back();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto& [ax, ay] = corners[i];
      const auto& [bx, by] = corners[(i + 1) % corners.size()];
      const int pieces = step > 0 ? 1 + static_cast<int>(std::hypot(bx - ax, by - ay) / step) : 1;
      for (int p = 0; p < pieces; ++p) {
        const double t = static_cast<double>(p) / pieces;
        ring.push_back({ax + (bx - ax) * t, ay + (by - ay) * t, 0});
      }
    }
  }
  std::vector<Ring2> flat;
  for (auto& ring : rings) {
    if (transformer != nullptr)
      if (auto moved = transformer->apply(ring); !moved)
        return fail(ErrorCode::InvalidArgument,
                    (box.rings.empty() ? "bbox: " : "polygon: ") + moved.error().message);
    auto& points = flat.emplace_back();
    points.reserve(ring.size());
    for (const Point3& point : ring) points.push_back({point.x, point.y});
  }
  return flat;
}

std::vector<Point3> densified_ring(double min_x, double min_y, double max_x, double max_y) {
  const std::array<Point3, 4> corners{
      {{min_x, min_y, 0}, {max_x, min_y, 0}, {max_x, max_y, 0}, {min_x, max_y, 0}}};
  std::vector<Point3> ring;
  for (std::size_t side = 0; side < 4; ++side) {
    const Point3 &a = corners[side], &b = corners[(side + 1) % 4];
    for (int i = 0; i + 1 < kPointsPerSide; ++i) {
      const double t = static_cast<double>(i) / (kPointsPerSide - 1);
      ring.push_back({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, 0});
    }
  }
  return ring;
}

}  // namespace citymesh::source
