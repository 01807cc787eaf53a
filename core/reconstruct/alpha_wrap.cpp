#include "core/reconstruct/alpha_wrap.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <exception>
#include <functional>

namespace citymesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace Simplification = CGAL::Surface_mesh_simplification;

struct WorkDone : std::exception {};

/// Ends the wrapping at its work limit.
class Watch : public CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
 public:
  explicit Watch(const WrapLimits& limits) : limits_(limits) {}

  template <class Wrapper, class Gate>
  void before_facet_treatment(const Wrapper&, const Gate&) {
    if (++steps_ > limits_.max_steps || limits_.stop.stop_requested()) throw WorkDone{};
  }

 private:
  const WrapLimits& limits_;
  std::size_t steps_ = 0;
};

/// Ends when the next collapse would change the volume around its edge by too much.
struct StopAtCost {
  double limit;
  template <class Cost, class Profile>
  bool operator()(const Cost& cost, const Profile&, std::size_t, std::size_t) const {
    return cost > limit;
  }
};

void thin_out(Mesh& mesh, double volume) {
  using Cost = Simplification::LindstromTurk_cost<Mesh>;
  using Placement = Simplification::Bounded_normal_change_placement<
      Simplification::LindstromTurk_placement<Mesh>>;
  Simplification::edge_collapse(mesh, StopAtCost{volume * volume},
                                CGAL::parameters::get_cost(Cost()).get_placement(Placement()));
  mesh.collect_garbage();
}

}  // namespace

std::optional<WrapMesh> alpha_wrap(std::span<const Point3> points,
                                   std::span<const Triangle> triangles, double alpha_m,
                                   double offset_m, const WrapLimits& limits) {
  try {
    std::vector<Kernel::Point_3> corners;
    corners.reserve(points.size());
    for (const Point3& p : points) corners.emplace_back(p.x, p.y, p.z);
    std::vector<std::array<std::size_t, 3>> faces;
    faces.reserve(triangles.size());
    for (const Triangle& t : triangles) faces.push_back({t[0], t[1], t[2]});
    Mesh mesh;
    Watch watch(limits);
    CGAL::alpha_wrap_3(corners, faces, alpha_m, offset_m, mesh, CGAL::parameters::default_values(),
                       CGAL::parameters::visitor(std::ref(watch)));
    thin_out(mesh, alpha_m * alpha_m * offset_m);

    WrapMesh result;
    for (const auto v : mesh.vertices()) {
      const Kernel::Point_3& p = mesh.point(v);
      result.points.push_back({p.x(), p.y(), p.z()});
    }
    for (const auto f : mesh.faces()) {
      Triangle t{};
      std::size_t i = 0;
      for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh))
        if (i < 3) t[i++] = static_cast<std::uint32_t>(v);
      result.triangles.push_back(t);
    }
    if (result.triangles.empty()) return {};
    return result;
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace citymesh
