#include "core/write/findings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <unordered_map>

#include "core/write/styles.h"

namespace citymesh {
namespace {

GridPoint gridded(const Point3& p) {
  return {std::llround(p.x * kGridStepsPerMetre), std::llround(p.y * kGridStepsPerMetre),
          std::llround(p.z * kGridStepsPerMetre)};
}

/// Faces by what issues know of them.
class Index {
 public:
  explicit Index(const Shell& shell) {
    for (std::uint32_t f = 0; f < shell.faces.size(); ++f) {
      const Face& face = shell.faces[f];
      if (const std::string& id = shell.surface_ids[face.source]; !id.empty())
        by_id_[id].push_back(f);
      for (const Ring& ring : face.rings)
        for (const std::uint32_t corner : ring)
          if (auto& faces = by_corner_[shell.points[corner]]; faces.empty() || faces.back() != f)
            faces.push_back(f);
    }
  }

  /// Faces of the surfaces that the text names: all of it, or words of it.
  std::vector<std::uint32_t> named_in(std::string_view where) const {
    std::vector<std::uint32_t> faces = of_id(where);
    for (std::size_t begin = 0; faces.empty() && begin < where.size();) {
      const std::size_t end = std::min(where.find(' ', begin), where.size());
      const auto named = of_id(where.substr(begin, end - begin));
      faces.insert(faces.end(), named.begin(), named.end());
      begin = end + 1;
    }
    return faces;
  }

  std::vector<std::uint32_t> at(const Point3& place) const {
    const auto found = by_corner_.find(gridded(place));
    return found == by_corner_.end() ? std::vector<std::uint32_t>{} : found->second;
  }

 private:
  std::vector<std::uint32_t> of_id(std::string_view id) const {
    const auto found = by_id_.find(id);
    return found == by_id_.end() ? std::vector<std::uint32_t>{} : found->second;
  }

  std::map<std::string, std::vector<std::uint32_t>, std::less<>> by_id_{};
  std::map<GridPoint, std::vector<std::uint32_t>> by_corner_{};
};

}  // namespace

std::vector<std::uint8_t> face_findings(const Shell& shell, std::span<const Issue> issues) {
  std::vector<std::uint8_t> styles(shell.faces.size(), style::kSound);
  if (issues.empty()) return styles;
  const Index index(shell);
  for (const Issue& issue : issues) {
    std::vector<std::uint32_t> faces = index.named_in(issue.where);
    if (issue.at) {
      // Of a surface of many faces, those at the place.
      const auto here = index.at(*issue.at);
      std::vector<std::uint32_t> both;
      std::set_intersection(faces.begin(), faces.end(), here.begin(), here.end(),
                            std::back_inserter(both));
      if (!both.empty())
        faces = std::move(both);
      else if (faces.empty())
        faces = here;
    }
    for (const std::uint32_t f : faces) styles[f] = std::max(styles[f], finding_style(issue.code));
  }
  return styles;
}

std::uint8_t gravest(std::span<const Issue> issues) {
  std::uint8_t worst = style::kSound;
  for (const Issue& issue : issues) worst = std::max(worst, finding_style(issue.code));
  return worst;
}

}  // namespace citymesh
