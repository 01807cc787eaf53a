#include "tests/support/mesh_checker/read_mesh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <unordered_set>

namespace mesh_checker {
namespace {

struct PointHash {
  std::size_t operator()(const Point& point) const {
    std::uint64_t hash = 1469598103934665603ULL;
    for (const double coordinate : point) {
      std::uint64_t bits;
      std::memcpy(&bits, &coordinate, sizeof bits);
      hash = (hash ^ bits) * 1099511628211ULL;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// Collects triangles of one body and welds equal coordinates.
class BodyBuilder {
 public:
  explicit BodyBuilder(std::string name) { body_.name = std::move(name); }

  const std::string& name() const { return body_.name; }

  void add(const std::array<Point, 3>& corners) {
    Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [place, is_new] =
          index_.try_emplace(corners[i], static_cast<std::uint32_t>(body_.points.size()));
      if (is_new) body_.points.push_back(corners[i]);
      triangle[i] = place->second;
    }
    body_.triangles.push_back(triangle);
  }

  void blame(const std::string& finding) {
    const auto& known = body_.findings;
    if (std::find(known.begin(), known.end(), finding) == known.end())
      body_.findings.push_back(finding);
  }

  Body take() { return std::move(body_); }

 private:
  Body body_;
  std::unordered_map<Point, std::uint32_t, PointHash> index_;
};

/// Lines of a text, and the words of each.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool next() {
    if (rest_.empty()) return false;
    const auto end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
  }

  std::string_view word() {
    const auto begin = line_.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) {
      line_ = {};
      return {};
    }
    const auto end = std::min(line_.find_first_of(" \t\r", begin), line_.size());
    const auto found = line_.substr(begin, end - begin);
    line_.remove_prefix(end);
    return found;
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw ReadError("line " + std::to_string(number_) + ": " + why);
  }

  double coordinate() {
    const auto text = word();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size() ||
        !std::isfinite(value))
      fail("'" + std::string(text) + "' is not a finite coordinate");
    return value + 0.0;  // -0 and 0 are the same place
  }

  Point point() {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    return {x, y, z};
  }

 private:
  std::string_view rest_;
  std::string_view line_{};
  std::size_t number_ = 0;
};

/// Index of an OBJ face corner `7`, `7/1`, `7//3` or `-1`, from 0.
std::size_t corner_index(Lines& lines, std::string_view text, std::size_t count) {
  const auto digits = text.substr(0, text.find('/'));
  long long index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size())
    lines.fail("'" + std::string(text) + "' is not a face corner");
  if (index < 0) index += static_cast<long long>(count) + 1;
  if (index < 1 || index > static_cast<long long>(count))
    lines.fail("face corner " + std::string(text) + " names none of the " + std::to_string(count) +
               " vertices before it");
  return static_cast<std::size_t>(index) - 1;
}

void blame_repeated_names(std::vector<Body>& bodies) {
  std::unordered_set<std::string_view> names;
  for (auto& body : bodies)
    if (!names.insert(body.name).second)
      body.findings.push_back("an earlier body has the same name");
}

}  // namespace

std::vector<Body> read_obj(std::string_view text) {
  constexpr std::uint32_t kNobody = 0xffffffff;
  std::vector<Point> points;
  std::vector<std::uint32_t> owners;  // body that uses the point
  std::vector<BodyBuilder> bodies;
  Lines lines(text);
  while (lines.next()) {
    const auto key = lines.word();
    if (key == "v") {
      points.push_back(lines.point());
      owners.push_back(kNobody);
    } else if (key == "o") {
      bodies.emplace_back(std::string(lines.word()));
    } else if (key == "g" && !bodies.empty()) {
      const auto group = lines.word();
      const auto& name = bodies.back().name();
      if (!group.starts_with(name + "__"))
        bodies.back().blame("group '" + std::string(group) + "' does not begin with its name");
    } else if (key == "f") {
      if (bodies.empty()) bodies.emplace_back("");
      const auto self = static_cast<std::uint32_t>(bodies.size() - 1);
      std::array<Point, 3> corners{};
      for (auto& corner : corners) {
        const auto index = corner_index(lines, lines.word(), points.size());
        if (owners[index] != kNobody && owners[index] != self)
          bodies.back().blame("shares a vertex with '" + bodies[owners[index]].name() + "'");
        owners[index] = self;
        corner = points[index];
      }
      if (!lines.word().empty()) bodies.back().blame("has a face with more than three corners");
      bodies.back().add(corners);
    }
  }
  std::vector<Body> result;
  for (auto& body : bodies) result.push_back(body.take());
  blame_repeated_names(result);
  return result;
}

std::vector<Body> read_stl(std::string_view text) {
  std::vector<BodyBuilder> bodies;
  Lines lines(text);
  bool in_solid = false;
  std::string_view name;
  std::array<Point, 3> corners{};
  std::size_t corner_count = 0;
  while (lines.next()) {
    const auto key = lines.word();
    if (key == "vertex") {
      if (!in_solid) lines.fail("vertex outside of a solid");
      if (corner_count == 3) lines.fail("facet with more than three corners");
      corners[corner_count++] = lines.point();
    } else if (key == "endfacet") {
      if (corner_count != 3) lines.fail("facet with fewer than three corners");
      if (bodies.empty() || bodies.back().name() != name) bodies.emplace_back(std::string(name));
      bodies.back().add(corners);
      corner_count = 0;
    } else if (key == "solid") {
      if (in_solid) lines.fail("solid inside a solid");
      in_solid = true;
      const auto solid = lines.word();
      const auto separator = solid.rfind("__");
      name = separator == std::string_view::npos ? solid : solid.substr(0, separator);
    } else if (key == "endsolid") {
      if (!in_solid) lines.fail("endsolid without solid");
      in_solid = false;
    } else if (!key.empty() && key != "facet" && key != "outer" && key != "endloop") {
      lines.fail("'" + std::string(key) + "' is not ASCII STL");
    }
  }
  if (in_solid || corner_count != 0) lines.fail("the file ends inside a solid");
  std::vector<Body> result;
  for (auto& body : bodies) result.push_back(body.take());
  blame_repeated_names(result);
  return result;
}

}  // namespace mesh_checker
