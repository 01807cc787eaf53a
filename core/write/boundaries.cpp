#include "core/write/boundaries.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace citymesh {
namespace {

/// Which surface an opening lies in: the one that most of its edges are shared with.
class Hosts {
 public:
  Hosts(const TriangleMesh& mesh, const std::vector<std::size_t>& surface_of_face,
        const std::vector<BoundarySurface>& surfaces)
      : mesh_(mesh) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const std::size_t s = surface_of_face[f];
      if (s == kNoBoundary || is_opening(surfaces[s].type)) continue;
      for_each_edge(f, [&](std::uint32_t a, std::uint32_t b) { surface_at_[{b, a}] = s; });
    }
  }

  /// kNoBoundary: no other surface touches it.
  std::size_t host_of(const BoundarySurface& opening) const {
    std::map<std::size_t, std::size_t> edges;
    for (const std::size_t f : opening.faces)
      for_each_edge(f, [&](std::uint32_t a, std::uint32_t b) {
        if (const auto at = surface_at_.find({a, b}); at != surface_at_.end()) ++edges[at->second];
      });
    std::size_t host = kNoBoundary, most = 0;
    for (const auto& [surface, count] : edges)
      if (count > most) {
        host = surface;
        most = count;
      }
    return host;
  }

 private:
  template <class Visit>
  void for_each_edge(std::size_t f, Visit&& visit) const {
    for (const Ring& ring : mesh_.faces[f].rings)
      for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  }

  const TriangleMesh& mesh_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> surface_at_{};
};

class Grouping {
 public:
  Grouping(CityGml version, const CityObject& object, BodyIds& ids)
      : version_(version), mesh_(object.body->mesh), ids_(ids) {
    int lod = solid_lod(*object.body)[0] - '0';
    if (version == CityGml::V3) lod = std::min(lod, 3);
    if (version == CityGml::V2 && object.kind == ObjectKind::BuildingInstallation)
      lod = std::max(lod, 2);
    all_.lod = std::clamp(lod, 1, 4);
    group();
  }

  Boundaries take() { return std::move(all_); }

 private:
  bool holds(SurfaceType type) const {
    if (type == SurfaceType::Unknown) return false;
    if (version_ == CityGml::V3) return true;
    return all_.lod >= (is_opening(type) ? 3 : 2);
  }

  void group() {
    all_.surface_of_face.assign(mesh_.faces.size(), kNoBoundary);
    all_.polygon_ids.resize(mesh_.faces.size());
    std::map<std::tuple<SurfaceType, std::uint32_t, std::string_view>, std::size_t> known;
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      const Face& face = mesh_.faces[f];
      const std::string_view source = face.source < mesh_.surface_ids.size()
                                          ? std::string_view(mesh_.surface_ids[face.source])
                                          : std::string_view();
      if (!holds(face.type)) {
        all_.polygon_ids[f] = ids_.take(source, 'p', f);
        continue;
      }
      const auto [at, is_new] =
          known.try_emplace({face.type, face.source, face.made_by}, all_.surfaces.size());
      if (is_new)
        all_.surfaces.push_back(
            {face.type, ids_.take(source, 'b', all_.surfaces.size()), face.made_by, {}, {}});
      all_.surfaces[at->second].faces.push_back(f);
      all_.surface_of_face[f] = at->second;
    }
    // Behind all ids that stay as they are.
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
      if (all_.polygon_ids[f].empty()) all_.polygon_ids[f] = ids_.generated('p', f);
    place_openings();
  }

  void place_openings() {
    const std::size_t count = all_.surfaces.size();
    if (std::none_of(all_.surfaces.begin(), all_.surfaces.end(),
                     [](const BoundarySurface& surface) { return is_opening(surface.type); }))
      return;
    const Hosts hosts(mesh_, all_.surface_of_face, all_.surfaces);
    for (std::size_t s = 0; s < count; ++s) {
      if (!is_opening(all_.surfaces[s].type)) continue;
      std::size_t host = hosts.host_of(all_.surfaces[s]);
      // A closure of 3.0 is no surface of a construction: only those have openings.
      if (host != kNoBoundary && version_ == CityGml::V3 &&
          all_.surfaces[host].type == SurfaceType::ClosureSurface)
        host = kNoBoundary;
      if (host == kNoBoundary) {  // the schema wants one: a wall that is nothing but its opening
        host = all_.surfaces.size();
        all_.surfaces.push_back({SurfaceType::WallSurface, ids_.generated('h', s), {}, {}, {}});
      }
      all_.surfaces[host].openings.push_back(s);
    }
  }

  CityGml version_;
  const TriangleMesh& mesh_;
  BodyIds& ids_;
  Boundaries all_{};
};

}  // namespace

bool is_opening(SurfaceType type) {
  return type == SurfaceType::Window || type == SurfaceType::Door;
}

Boundaries boundaries_of(CityGml version, const CityObject& object, BodyIds& ids) {
  return Grouping(version, object, ids).take();
}

}  // namespace citymesh
