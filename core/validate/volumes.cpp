#include "core/validate/volumes.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_incremental_builder_3.h>

#include <exception>

namespace citymesh {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;

class Builder : public CGAL::Modifier_base<Polyhedron::HalfedgeDS> {
 public:
  explicit Builder(const ClosedSurface& surface) : surface_(surface) {}

  void operator()(Polyhedron::HalfedgeDS& target) override {
    CGAL::Polyhedron_incremental_builder_3<Polyhedron::HalfedgeDS> builder(target, false);
    builder.begin_surface(surface_.points.size(), surface_.triangles.size());
    for (const GridPoint& p : surface_.points)
      builder.add_vertex(Kernel::Point_3(static_cast<double>(p.x), static_cast<double>(p.y),
                                         static_cast<double>(p.z)));
    for (const Triangle& t : surface_.triangles)
      if (!builder.error()) builder.add_facet(t.begin(), t.end());
    if (!builder.error()) builder.remove_unconnected_vertices();
    builder.end_surface();
  }

 private:
  const ClosedSurface& surface_;
};

std::optional<Nef> volume_of(const ClosedSurface& surface) {
  Polyhedron polyhedron;
  Builder builder(surface);
  polyhedron.delegate(builder);
  if (!polyhedron.is_valid() || !polyhedron.is_closed()) return {};
  return Nef(polyhedron);
}

std::optional<Nef> volume_of(const SolidBody& solid) {
  auto volume = volume_of(solid.exterior);
  for (const ClosedSurface& cavity : solid.cavities) {
    const auto hole = volume_of(cavity);
    if (!volume || !hole) return {};
    *volume -= *hole;
  }
  return volume;
}

std::size_t triangles_of(const SolidBody& solid) {
  std::size_t count = solid.exterior.triangles.size();
  for (const ClosedSurface& cavity : solid.cavities) count += cavity.triangles.size();
  return count;
}

/// CGAL reports what it cannot do by exceptions.
template <class Value, class Compute>
std::optional<Value> attempt(std::size_t triangles, Compute&& compute) {
  if (triangles > kMaxVolumeTriangles) return {};
  try {
    return compute();
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

std::optional<bool> volumes_overlap(const SolidBody& a, const SolidBody& b) {
  return attempt<bool>(triangles_of(a) + triangles_of(b), [&]() -> std::optional<bool> {
    const auto s = volume_of(a), t = volume_of(b);
    if (!s || !t) return {};
    return !(s->interior() * t->interior()).is_empty();
  });
}

std::optional<bool> volume_within(const ClosedSurface& inner, const ClosedSurface& outer) {
  return attempt<bool>(inner.triangles.size() + outer.triangles.size(),
                       [&]() -> std::optional<bool> {
                         const auto s = volume_of(inner), t = volume_of(outer);
                         if (!s || !t) return {};
                         return (s->interior() - *t).is_empty();
                       });
}

std::optional<std::size_t> interior_pieces(const SolidBody& solid) {
  return attempt<std::size_t>(triangles_of(solid), [&]() -> std::optional<std::size_t> {
    const auto volume = volume_of(solid);
    if (!volume) return {};
    std::size_t pieces = 0;
    for (auto v = volume->volumes_begin(); v != volume->volumes_end(); ++v)
      if (v->mark()) ++pieces;
    return pieces;
  });
}

}  // namespace citymesh
