#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry/around_edge.h"
#include "core/geometry/outline.h"
#include "core/geometry/triangulation.h"
#include "core/heal/steps.h"
#include "core/validate/validate.h"

namespace citymesh {
namespace {

constexpr double kSameSlope = 0.985;  ///< cosine of 10 degrees: pieces turn less than that

double length(const Point3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Triangles of one face in groups that hang together and lie near the plane of the largest
/// triangle of each.
std::vector<std::vector<Triangle>> plane_pieces(std::span<const GridPoint> points,
                                                const std::vector<Triangle>& triangles,
                                                double tolerance_m) {
  const EdgeFans fans = edge_fans(triangles);
  std::vector<Point3> normals;
  normals.reserve(triangles.size());
  for (const Triangle& t : triangles)
    normals.push_back(normal_of(points[t[0]], points[t[1]], points[t[2]]));
  std::vector<std::uint32_t> by_area(triangles.size());
  std::iota(by_area.begin(), by_area.end(), 0u);
  std::stable_sort(by_area.begin(), by_area.end(), [&](std::uint32_t a, std::uint32_t b) {
    return length(normals[a]) > length(normals[b]);
  });

  std::vector<bool> taken(triangles.size(), false);
  std::vector<std::vector<Triangle>> pieces;
  for (const std::uint32_t seed : by_area) {
    if (taken[seed]) continue;
    const GridPoint& base = points[triangles[seed][0]];
    const Point3& normal = normals[seed];
    const auto near = [&](std::uint32_t corner) {
      const GridPoint& p = points[corner];
      const Point3 to_p = to_metres({p.x - base.x, p.y - base.y, p.z - base.z});
      return std::abs(dot(normal, to_p)) <= tolerance_m / 2 * length(normal);
    };
    std::vector<std::uint32_t> piece{seed};
    taken[seed] = true;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Triangle at = triangles[piece[i]];
      for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t a = at[side], b = at[(side + 1) % 3];
        for (const EdgeFacet& other : fans.at({std::min(a, b), std::max(a, b)})) {
          if (taken[other.facet] || !near(other.apex) ||
              dot(normals[other.facet], normal) <
                  kSameSlope * length(normals[other.facet]) * length(normal))
            continue;
          taken[other.facet] = true;
          piece.push_back(other.facet);
        }
      }
    }
    std::sort(piece.begin(), piece.end());
    std::vector<Triangle>& group = pieces.emplace_back();
    for (const std::uint32_t t : piece) group.push_back(triangles[t]);
  }
  return pieces;
}

}  // namespace

std::vector<GridPoint> split_uneven_faces(Shell& shell, const std::vector<bool>& sound,
                                          double planarity_tolerance_m, bool into_triangles) {
  std::vector<GridPoint> places;
  std::vector<Face> faces;
  faces.reserve(shell.faces.size());
  for (std::size_t f = 0; f < sound.size(); ++f) {
    Face& face = shell.faces[f];
    const auto triangles = triangulate(shell.points, face.rings);
    if (sound[f] || !triangles) {
      faces.push_back(std::move(face));
      continue;
    }
    places.push_back(shell.points[face.rings[0][0]]);
    const auto add = [&](std::vector<Ring> rings) {
      faces.push_back(face);
      faces.back().rings = std::move(rings);
    };
    for (const std::vector<Triangle>& piece :
         plane_pieces(shell.points, *triangles, planarity_tolerance_m)) {
      std::vector<Ring> rings;
      if (!into_triangles) rings = polygon_of(shell.points, piece);
      if (!rings.empty())
        add(std::move(rings));
      else
        for (const Triangle& t : piece) add({Ring(t.begin(), t.end())});
    }
  }
  shell.faces = std::move(faces);
  return places;
}

}  // namespace citymesh
