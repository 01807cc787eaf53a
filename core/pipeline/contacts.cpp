#include "core/pipeline/contacts.h"

#include "core/geometry/measure.h"
#include "core/geometry/predicates.h"

namespace citymesh {
namespace {

std::array<GridPoint, 3> corners(const std::vector<std::array<std::int32_t, 3>>& points,
                                 const Triangle& t) {
  const auto at = [&](std::uint32_t i) {
    return GridPoint{points[i][0], points[i][1], points[i][2]};
  };
  return {at(t[0]), at(t[1]), at(t[2])};
}

GridBox box_around(const std::array<GridPoint, 3>& triangle) {
  GridBox box = GridBox::of(triangle[0]);
  box.add(triangle[1]);
  box.add(triangle[2]);
  return box;
}

}  // namespace

void Contacts::add(const TriangleMesh& mesh) {
  triangles_ += mesh.triangles.size();
  if (triangles_ > kMaxTriangles) {
    bodies_.clear();
    bodies_.shrink_to_fit();
    return;
  }
  if (mesh.points.empty()) return;
  Kept kept;
  kept.box = GridBox::of(mesh.points[0]);
  kept.points.reserve(mesh.points.size());
  for (const GridPoint& p : mesh.points) {  // the gates hold: every coordinate fits 32 bits
    kept.box.add(p);
    kept.points.push_back({static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y),
                           static_cast<std::int32_t>(p.z)});
  }
  kept.triangles = mesh.triangles;
  bodies_.push_back(std::move(kept));
}

bool Contacts::meet(const Kept& a, const Kept& b) {
  std::vector<std::array<GridPoint, 3>> near;
  std::vector<GridBox> boxes;
  for (const Triangle& t : a.triangles) {
    const auto triangle = corners(a.points, t);
    const GridBox box = box_around(triangle);
    if (!box.meets(b.box)) continue;
    near.push_back(triangle);
    boxes.push_back(box);
  }
  const BoxTree tree(boxes);
  for (const Triangle& t : b.triangles) {
    const auto triangle = corners(b.points, t);
    const GridBox box = box_around(triangle);
    if (!box.meets(a.box)) continue;
    bool touch = false;
    tree.for_each_meeting(
        box, [&](std::uint32_t i) { touch = touch || triangles_meet(near[i], triangle); });
    if (touch) return true;
  }
  return false;
}

std::optional<std::uint64_t> Contacts::count() const {
  if (triangles_ > kMaxTriangles) return {};
  std::vector<GridBox> boxes;
  boxes.reserve(bodies_.size());
  for (const Kept& body : bodies_) boxes.push_back(body.box);
  const BoxTree tree(boxes);
  std::uint64_t pairs = 0;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i)
    tree.for_each_meeting(boxes[i], [&](std::uint32_t j) {
      if (j > i && meet(bodies_[i], bodies_[j])) ++pairs;
    });
  return pairs;
}

}  // namespace citymesh
