#include <algorithm>
#include <cmath>
#include <utility>

#include "core/citymodel/edges.h"
#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"

namespace citymesh {
namespace {

/// Faces that hang together across edges of two.
class Sheets {
 public:
  Sheets(const Shell& shell, const EdgeUses& uses) : sheet_of_(shell.faces.size(), kNone) {
    std::vector<std::vector<std::uint32_t>> links(shell.faces.size());
    for (const auto& [edge, faces] : uses) {
      if (faces.size() != 2) continue;
      links[faces[0].face].push_back(faces[1].face);
      links[faces[1].face].push_back(faces[0].face);
    }
    for (std::uint32_t seed = 0; seed < sheet_of_.size(); ++seed) {
      if (sheet_of_[seed] != kNone) continue;
      std::vector<std::uint32_t> sheet{seed};
      sheet_of_[seed] = sheets_.size();
      for (std::size_t i = 0; i < sheet.size(); ++i)
        for (const std::uint32_t next : links[sheet[i]])
          if (std::exchange(sheet_of_[next], sheets_.size()) == kNone) sheet.push_back(next);
      sheets_.push_back(std::move(sheet));
    }
  }
  const std::vector<std::vector<std::uint32_t>>& all() const { return sheets_; }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> sheet_of_;
  std::vector<std::vector<std::uint32_t>> sheets_;
};

/// A window or door off its wall bounds nothing either, but it tells what fills the wall's hole.
bool has_opening(const Shell& shell, const std::vector<std::uint32_t>& sheet) {
  return std::any_of(sheet.begin(), sheet.end(), [&](std::uint32_t f) {
    return shell.faces[f].type == SurfaceType::Window || shell.faces[f].type == SurfaceType::Door;
  });
}

/// Whether all corners of the faces lie in the plane of the first one.
bool is_flat(const Shell& shell, const std::vector<std::uint32_t>& sheet, double tolerance_m) {
  const Ring& first = shell.faces[sheet[0]].rings[0];
  const Point3 n = ring_normal(shell.points, first);
  const double length = std::hypot(n.x, n.y, n.z);
  if (length <= 0) return false;
  const GridPoint& base = shell.points[first[0]];
  for (const std::uint32_t f : sheet)
    for (const Ring& ring : shell.faces[f].rings)
      for (const std::uint32_t corner : ring) {
        const GridPoint& p = shell.points[corner];
        const double d = n.x * static_cast<double>(p.x - base.x) +
                         n.y * static_cast<double>(p.y - base.y) +
                         n.z * static_cast<double>(p.z - base.z);
        if (std::abs(d) / length * kGridStep_m > tolerance_m) return false;
      }
  return true;
}

}  // namespace

void drop_inner_sheets(Shell& shell, StepContext& context) {
  const EdgeUses uses(shell);
  if (std::all_of(uses.begin(), uses.end(),
                  [](const auto& edge) { return edge.second.size() == 2; }))
    return;
  const Sheets sheets(shell, uses);
  if (sheets.all().size() < 2) return;
  std::vector<char> gone(shell.faces.size(), 0);
  for (const std::vector<std::uint32_t>& sheet : sheets.all()) {
    if (!is_flat(shell, sheet, context.planarity_tolerance_m) || has_opening(shell, sheet))
      continue;
    for (const std::uint32_t f : sheet) {
      gone[f] = 1;
      context.note("inner_face_dropped", shell.points[shell.faces[f].rings[0][0]]);
    }
  }
  std::vector<Face> kept;
  for (std::size_t f = 0; f < gone.size(); ++f)
    if (!gone[f]) kept.push_back(std::move(shell.faces[f]));
  shell.faces = std::move(kept);
}

}  // namespace citymesh
