#include <algorithm>
#include <map>

#include "core/citymodel/spikes.h"
#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"

namespace citymesh {
namespace {

/// Cuts a ring at corners it visits twice into rings that visit every corner once.
std::vector<Ring> split_at_touches(const Ring& ring) {
  std::vector<Ring> simple;
  Ring path;
  std::map<std::uint32_t, std::size_t> position;
  for (const std::uint32_t corner : ring) {
    const auto seen = position.find(corner);
    if (seen != position.end()) {
      const auto from = static_cast<std::ptrdiff_t>(seen->second);
      simple.emplace_back(path.begin() + from, path.end());
      for (auto it = path.begin() + from; it != path.end(); ++it) position.erase(*it);
      path.erase(path.begin() + from, path.end());
    }
    position[corner] = path.size();
    path.push_back(corner);
  }
  simple.push_back(std::move(path));
  return simple;
}

/// Rings that visit each of their corners once have neither repeats nor spikes nor touches.
bool is_clean(const Face& face) {
  return std::all_of(face.rings.begin(), face.rings.end(), [](Ring ring) {
    if (ring.size() < 3) return false;
    std::sort(ring.begin(), ring.end());
    return std::adjacent_find(ring.begin(), ring.end()) == ring.end();
  });
}

double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace

void clean_rings(Shell& shell, StepContext& context) {
  std::vector<Face> cleaned;
  cleaned.reserve(shell.faces.size());
  for (Face& face : shell.faces) {
    const std::string& id = shell.surface_ids[face.source];
    if (face.rings.empty()) continue;
    if (is_clean(face)) {
      cleaned.push_back(std::move(face));
      continue;
    }
    std::vector<Ring> exteriors, holes;
    Point3 normal{};
    for (std::size_t r = 0; r < face.rings.size(); ++r) {
      Ring& ring = face.rings[r];
      if (r == 0) normal = ring_normal(shell.points, ring);
      if (drop_repeats_and_spikes(ring)) context.note("ring_cleaned", id);
      if (ring.empty()) {
        context.note(r == 0 ? "face_dropped" : "hole_dropped", id);
        if (r == 0) break;
        continue;
      }
      std::vector<Ring> parts = split_at_touches(ring);
      if (parts.size() > 1) context.note("ring_split", id);
      for (Ring& part : parts) {
        drop_repeats_and_spikes(part);
        if (part.empty()) continue;
        // A loop that runs against its exterior is a hole of it, not an area (S3-10 b).
        const bool along = dot(ring_normal(shell.points, part), normal) > 0;
        (r == 0 && (along || parts.size() == 1) ? exteriors : holes).push_back(std::move(part));
      }
    }
    if (exteriors.empty()) continue;
    if (exteriors.size() == 1) {
      face.rings = {std::move(exteriors[0])};
      for (Ring& hole : holes) face.rings.push_back(std::move(hole));
      cleaned.push_back(std::move(face));
      continue;
    }
    // Several areas: each hole goes to the area whose projection holds its first corner.
    const Axis axis = dominant_axis(normal);
    std::vector<Face> areas;
    for (Ring& exterior : exteriors) {
      Face area = face;
      area.rings = {std::move(exterior)};
      areas.push_back(std::move(area));
    }
    for (Ring& hole : holes) {
      Face* owner = &areas[0];
      for (Face& area : areas) {
        const Ring& ring = area.rings[0];
        bool inside = false;
        const GridPoint2 p = project(shell.points[hole[0]], axis);
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const GridPoint2 a = project(shell.points[ring[i]], axis),
                           b = project(shell.points[ring[(i + 1) % ring.size()]], axis);
          if ((a.y > p.y) != (b.y > p.y) && (orient2d(a, b, p) > 0) == (b.y > a.y))
            inside = !inside;
        }
        if (inside) {
          owner = &area;
          break;
        }
      }
      owner->rings.push_back(std::move(hole));
    }
    for (Face& area : areas) cleaned.push_back(std::move(area));
  }
  shell.faces = std::move(cleaned);
}

}  // namespace citymesh
