#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/source/feature.h"
#include "core/source/input.h"

/// What the readers of mesh files share: polygons over one list of points, each in a building.
namespace citymesh::source {

/// Collects the points and faces of a file as they come and hands over its buildings at the end.
/// A building that has more corners than `max_points_per_building` keeps none of them.
class Soup {
 public:
  explicit Soup(const DocumentOptions& options) : options_(options) {}

  /// Building that the next faces belong to. `id` may be empty.
  std::uint32_t add_building(std::string id);
  std::uint32_t building_count() const { return static_cast<std::uint32_t>(buildings_.size()); }

  /// false: more points than a 32-bit index reaches.
  bool add_point(const Point3& point);
  std::size_t point_count() const { return points_.size(); }

  void begin_face(std::uint32_t building, std::optional<SurfaceType> type = std::nullopt);
  void next_ring();
  /// Point `index`, counted from 0, that may come later in the file. `stated` is what the file
  /// calls it.
  void add_corner(std::int64_t index, std::int64_t stated);
  /// A corner at a point that no other face has.
  void add_own_corner(const Point3& point);

  void report(std::uint32_t building, int code, const std::string& what, double measured = 0);

  /// One feature per building that has faces, in order; when there is none, one without geometry.
  Result<void> deliver(GeometryType type, const FeatureSink& sink);
  /// Instead of `deliver`: one building without geometry, for a file that has too many points.
  Result<void> deliver_too_large(const FeatureSink& sink);

 private:
  struct Face {
    std::uint32_t first_ring = 0;
    std::uint32_t building = 0;
    std::int32_t surface = -1;
    std::uint32_t number = 0;  ///< in the file, from 1
    bool usable = true;
  };
  struct Group {
    std::string id{};
    std::vector<Surface> surfaces{};
    std::vector<Issue> issues{};
    std::uint64_t corners = 0, rings = 0, faces = 0;
  };
  bool too_large(const Group& group) const {
    return std::max(group.corners, group.rings) > options_.limits.max_points_per_building;
  }
  bool storing() const;
  std::int32_t surface_of(Group& group, SurfaceType type);
  void make_feature(std::uint32_t building, const std::uint32_t* faces, std::size_t count,
                    GeometryType type, Feature& feature);
  void copy_face(std::uint32_t place, Feature& feature);

  const DocumentOptions& options_;
  std::vector<Point3> points_{};
  std::vector<std::uint32_t> corners_{};  ///< indices into `points_`
  std::vector<std::uint32_t> rings_{};    ///< where in `corners_` each begins
  std::vector<Face> faces_{};
  std::vector<Group> buildings_{};
  std::uint32_t current_ = 0;  ///< building of the face being added
  std::uint64_t face_number_ = 0;
};

/// "Wall" and WallSurface of "Wall__WallSurface", as our own files name patches; no type when the
/// end is no surface type.
struct PatchName {
  std::string_view building{};
  std::optional<SurfaceType> type{};
};
PatchName split_patch_name(std::string_view name);

/// The next word of a line, which is cut off from it; empty at the end.
std::string_view next_word(std::string_view& line);

/// A coordinate: too large becomes infinite, too small zero. None for what is no number.
std::optional<double> coordinate_from(std::string_view word);
/// Three coordinates at the start of a line.
std::optional<Point3> point_from(std::string_view& line);

/// The next line that says something, trimmed and without its comment ('#'); `text` holds it. false
/// at the end or after a failure, which is noted.
bool next_statement(Input& input, std::string& text, std::string_view& line, DocumentFacts& facts);

Error reading_stopped();
/// "line 12: what", kept unless there is an earlier reason.
void fail_at_line(DocumentFacts& facts, std::uint64_t line, const std::string& what);
void fail_reading(DocumentFacts& facts, std::string what);

}  // namespace citymesh::source
