#include "core/source/soup.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/text.h"
#include "core/citymodel/issue.h"
#include "core/source/positions.h"

namespace citymesh::source {
namespace {

constexpr std::uint32_t kNoPoint = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxIssues = 1000;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

std::uint32_t Soup::add_building(std::string id) {
  buildings_.push_back({.id = std::move(id)});
  return building_count() - 1;
}

bool Soup::add_point(const Point3& point) {
  if (points_.size() >= kNoPoint) return false;
  points_.push_back(point);
  return true;
}

std::int32_t Soup::surface_of(Group& group, SurfaceType type) {
  for (std::size_t i = 0; i < group.surfaces.size(); ++i)
    if (group.surfaces[i].type == type) return static_cast<std::int32_t>(i);
  group.surfaces.push_back({.type = type});
  return static_cast<std::int32_t>(group.surfaces.size() - 1);
}

bool Soup::storing() const {
  return !too_large(buildings_[current_]) && corners_.size() < kNoPoint && rings_.size() < kNoPoint;
}

void Soup::begin_face(std::uint32_t building, std::optional<SurfaceType> type) {
  current_ = building;
  ++face_number_;
  Group& group = buildings_[building];
  ++group.faces;
  if (storing()) {
    Face face{.first_ring = static_cast<std::uint32_t>(rings_.size()),
              .building = building,
              .number = static_cast<std::uint32_t>(face_number_)};
    if (type) face.surface = surface_of(group, *type);
    faces_.push_back(face);
  }
  next_ring();
}

void Soup::next_ring() {
  ++buildings_[current_].rings;
  if (storing()) rings_.push_back(static_cast<std::uint32_t>(corners_.size()));
}

void Soup::add_corner(std::int64_t index, std::int64_t stated) {
  ++buildings_[current_].corners;
  if (!storing()) return;
  if (index >= 0 && index < kNoPoint) {
    corners_.push_back(static_cast<std::uint32_t>(index));
    return;
  }
  Face& face = faces_.back();
  if (face.usable)
    report(current_, issue_code::kVertexIndexOutOfRange,
           "face " + std::to_string(face.number) + ": vertex " + std::to_string(stated),
           static_cast<double>(stated));
  face.usable = false;
}

void Soup::add_own_corner(const Point3& point) {
  const auto index = static_cast<std::int64_t>(points_.size());
  if (storing()) add_point(point);
  add_corner(index, index);
}

void Soup::report(std::uint32_t building, int code, const std::string& what, double measured) {
  auto& issues = buildings_[building].issues;
  if (issues.size() < kMaxIssues) issues.push_back({code, what, measured});
}

void Soup::copy_face(std::uint32_t place, Feature& feature) {
  const Face& face = faces_[place];
  const auto unusable = [&](int code, const std::string& what, double measured) {
    report(face.building, code, "face " + std::to_string(face.number) + ": " + what, measured);
    return false;
  };
  RawPolygon polygon{.first_ring = static_cast<std::uint32_t>(feature.rings.size()),
                     .object = 0,
                     .surface = face.surface,
                     .usable = face.usable};
  const std::size_t rings_end =
      place + 1 < faces_.size() ? faces_[place + 1].first_ring : rings_.size();
  for (std::size_t r = face.first_ring; r < rings_end; ++r) {
    const std::size_t end = r + 1 < rings_.size() ? rings_[r + 1] : corners_.size();
    RawRing ring{static_cast<std::uint32_t>(feature.points.size()), 0};
    for (std::size_t c = rings_[r]; c < end && polygon.usable; ++c) {
      const std::uint32_t index = corners_[c];
      if (index >= points_.size()) {
        polygon.usable = unusable(issue_code::kVertexIndexOutOfRange,
                                  "vertex " + std::to_string(index) + " of " +
                                      std::to_string(points_.size()) + ", counted from 0",
                                  index);
        break;
      }
      const Point3& point = points_[index];
      const double largest = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
      if (std::isnan(point.x) || std::isnan(point.y) || std::isnan(point.z))
        polygon.usable = unusable(issue_code::kNonFiniteCoordinate,
                                  "vertex " + std::to_string(index) + " is not a number", 0);
      else if (!(largest <= kMaxCoordinate))
        polygon.usable =
            unusable(issue_code::kCoordinateOutOfRange, "vertex " + std::to_string(index), largest);
      feature.points.push_back(point);
      ++ring.count;
    }
    if (ring.count == 0 && polygon.usable)
      polygon.usable = unusable(issue_code::kUnreadableRing, "no vertices", 0);
    feature.rings.push_back(ring);
    ++polygon.ring_count;
  }
  if (polygon.usable)
    feature.objects.front().shapes.front().uses.push_back(
        {static_cast<std::uint32_t>(feature.polygons.size()), false});
  feature.polygons.push_back(std::move(polygon));
}

void Soup::make_feature(std::uint32_t building, const std::uint32_t* faces, std::size_t count,
                        GeometryType type, Feature& feature) {
  constexpr Lod kLod{2, -1};  // the formats state none
  feature.clear();
  RawObject& object = feature.objects.emplace_back();
  object.shapes.push_back({.type = type, .lod = kLod});
  Group& group = buildings_[building];
  if (too_large(group))
    report(building, issue_code::kReadLimitExceeded,
           "more than max_points_per_building = " +
               std::to_string(options_.limits.max_points_per_building) + " points");
  else
    for (std::size_t i = 0; i < count; ++i) copy_face(faces[i], feature);

  RawShape& shape = object.shapes.front();
  if (shape.uses.empty()) {
    object.shapes.clear();
  } else if (type == GeometryType::Solid) {
    Solid& solid = shape.solids.emplace_back();
    for (std::uint32_t u = 0; u < shape.uses.size(); ++u) solid.exterior.push_back(u);
  }
  object.gml_id = std::move(group.id);
  object.surfaces = std::move(group.surfaces);
  object.issues = std::move(group.issues);
}

Result<void> Soup::deliver(GeometryType type, const FeatureSink& sink) {
  std::uint64_t with_faces = 0;
  for (const Group& group : buildings_) with_faces += group.faces > 0 ? 1 : 0;
  if (with_faces == 0) {
    if (buildings_.empty()) add_building({});
    report(0, issue_code::kUnreadableGeometry, "the file has no faces");
    ++buildings_.front().faces;
    with_faces = 1;
  }

  // Faces sorted by building, each in the order of the file.
  std::vector<std::uint32_t> begin(buildings_.size() + 1, 0);
  for (const Face& face : faces_) ++begin[face.building + 1];
  for (std::size_t b = 1; b < begin.size(); ++b) begin[b] += begin[b - 1];
  std::vector<std::uint32_t> sorted(faces_.size());
  std::vector<std::uint32_t> next(begin);
  for (std::uint32_t f = 0; f < faces_.size(); ++f) sorted[next[faces_[f].building]++] = f;

  Feature feature;
  std::uint64_t ordinal = 0;
  for (std::uint32_t b = 0; b < building_count(); ++b) {
    Group& group = buildings_[b];
    if (group.faces == 0) continue;
    if (options_.stop.stop_requested()) return reading_stopped();
    ++ordinal;
    if (group.id.empty())
      group.id = with_faces == 1 ? options_.stem : numbered_id(options_.stem, ordinal);
    make_feature(b, sorted.data() + begin[b], begin[b + 1] - begin[b], type, feature);
    if (auto taken = sink(feature); !taken) return taken;
  }
  return {};
}

Result<void> Soup::deliver_too_large(const FeatureSink& sink) {
  points_ = {};
  corners_ = {};
  rings_ = {};
  faces_ = {};
  buildings_ = {};
  add_building({});
  buildings_.front().faces = 1;
  buildings_.front().corners = options_.limits.max_points_per_building + 1;
  return deliver(GeometryType::MultiSurface, sink);
}

PatchName split_patch_name(std::string_view name) {
  const auto at = name.rfind("__");
  if (at == std::string_view::npos || at == 0) return {name, std::nullopt};
  const auto type = surface_type_from(name.substr(at + 2));
  if (!type) return {name, std::nullopt};
  return {name.substr(0, at), type};
}

std::string_view next_word(std::string_view& line) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  std::size_t length = 0;
  while (length < line.size() && !is_blank(line[length])) ++length;
  const auto word = line.substr(0, length);
  line.remove_prefix(length);
  return word;
}

std::optional<double> coordinate_from(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);  // from_chars takes no plus sign
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc{}) return value;
  const bool small = word.find("e-") != word.npos || word.find("E-") != word.npos;
  return small ? 0.0 : std::numeric_limits<double>::infinity();
}

std::optional<Point3> point_from(std::string_view& line) {
  const auto x = coordinate_from(next_word(line));
  const auto y = coordinate_from(next_word(line));
  const auto z = coordinate_from(next_word(line));
  if (!x || !y || !z) return std::nullopt;
  return Point3{*x, *y, *z};
}

bool next_statement(Input& input, std::string& text, std::string_view& line, DocumentFacts& facts) {
  for (;;) {
    const auto more = input.next_line(text);
    if (!more) fail_reading(facts, more.error().message);
    if (!more || !*more) return false;
    line = trimmed(std::string_view(text).substr(0, text.find('#')));
    if (!line.empty()) return true;
  }
}

Error reading_stopped() { return fail(ErrorCode::Cancelled, "reading was stopped"); }

void fail_reading(DocumentFacts& facts, std::string what) {
  if (facts.failure.empty()) facts.failure = std::move(what);
}

void fail_at_line(DocumentFacts& facts, std::uint64_t line, const std::string& what) {
  fail_reading(facts, "line " + std::to_string(line) + ": " + what);
}

}  // namespace citymesh::source
