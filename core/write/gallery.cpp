#include "core/write/gallery.h"

#include <algorithm>
#include <set>

#include "core/geometry/triangulation.h"
#include "core/write/findings.h"
#include "core/write/html.h"
#include "core/write/report_json.h"
#include "core/write/shell_faces.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

constexpr double kPanelWidth = 300, kPanelHeight = 220, kMargin = 14;
constexpr std::size_t kShownAtOnce = 12;

// ---- what changed ----

/// A face as a value: its rings, each from its smallest corner on.
using FaceKey = std::vector<std::vector<GridPoint>>;

FaceKey key_of(std::span<const GridPoint> points, const Face& face) {
  FaceKey key;
  for (const Ring& ring : face.rings) {
    auto& corners = key.emplace_back();
    for (const std::uint32_t corner : ring) corners.push_back(points[corner]);
    if (!corners.empty())
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  }
  return key;
}

std::set<FaceKey> keys_of(std::span<const SourceBody> sources) {
  std::set<FaceKey> keys;
  for (const SourceBody& source : sources)
    for (const Face& face : source.shell.faces) keys.insert(key_of(source.shell.points, face));
  return keys;
}

/// What is not in the source is tinted by its rung, what closes a hole stands out.
std::vector<std::uint8_t> change_styles(const Body& body, const std::set<FaceKey>& source) {
  std::vector<std::uint8_t> styles;
  styles.reserve(body.mesh.faces.size());
  for (const Face& face : body.mesh.faces)
    styles.push_back(source.contains(key_of(body.mesh.points, face)) ? style::kSound
                     : face.made_by == body.rung                     ? style::kNew
                                                                     : rung_style(body.rung));
  return styles;
}

// ---- the view ----

GridPoint turned(GridPoint p, int quarters) {
  for (int i = 0; i < quarters; ++i) p = {-p.y, p.x, p.z};
  return p;
}

Point3 turned(Point3 p, int quarters) {
  for (int i = 0; i < quarters; ++i) p = {-p.y, p.x, p.z};
  return p;
}

std::vector<GridPoint> turned(std::span<const GridPoint> points, int quarters) {
  std::vector<GridPoint> all;
  all.reserve(points.size());
  for (const GridPoint& p : points) all.push_back(turned(p, quarters));
  return all;
}

/// One half of a picture: what stands there, with the style of every face.
struct Half {
  std::span<const GridPoint> points{};
  std::span<const Face> faces{};
  std::vector<std::uint8_t> styles{};
};

/// The quarter turn from which most is seen of what is not sound.
int best_turn(const std::vector<Half>& before, const std::vector<Half>& after) {
  std::array<double, 4> seen{};
  const auto look = [&](const Half& half, bool both_sides) {
    for (std::size_t f = 0; f < half.faces.size(); ++f) {
      if (half.styles[f] == style::kSound || half.faces[f].rings.empty()) continue;
      const Point3 normal = ring_normal(half.points, half.faces[f].rings[0]);
      for (int q = 0; q < 4; ++q) {
        const double towards = towards_viewer(to_view(turned(normal, q)));
        seen[static_cast<std::size_t>(q)] +=
            both_sides ? std::abs(towards) : std::max(0.0, towards);
      }
    }
  };
  for (const Half& half : before) look(half, true);
  for (const Half& half : after) look(half, false);
  constexpr double kClearlyBetter = 1.1;
  int best = 0;
  for (int q = 1; q < 4; ++q)
    if (seen[static_cast<std::size_t>(q)] > kClearlyBetter * seen[static_cast<std::size_t>(best)])
      best = q;
  return best;
}

void draw(const std::vector<Half>& halves, int quarters, std::uint8_t back,
          std::vector<DrawnFace>& to) {
  for (const Half& half : halves)
    for (DrawnFace& face :
         drawn_faces(turned(half.points, quarters), half.faces, half.styles, back))
      to.push_back(std::move(face));
}

// ---- the page ----

std::vector<Issue> all_issues(const BuildingReport& report, std::vector<Issue> PartReport::*which) {
  std::vector<Issue> issues = report.*which;
  for (const PartReport& part : report.parts)
    issues.insert(issues.end(), (part.*which).begin(), (part.*which).end());
  return issues;
}

std::string caption_of(const BuildingReport& report) {
  const auto before = all_issues(report, &PartReport::issues_before);
  const auto after = all_issues(report, &PartReport::issues_after);
  std::size_t repairs = report.repairs.size();
  for (const PartReport& part : report.parts) repairs += part.repairs.size();
  std::string html = "<b class=\"id\">" + escaped(report.gml_id) + "</b> " +
                     rung_chip(report.rung, report.outcome) + "<br>";
  std::set<int> codes;
  for (const Issue& issue : before) codes.insert(issue.code);
  std::size_t shown = 0;
  constexpr std::size_t kShown = 4;
  for (const int code : codes) {
    if (shown++ == kShown) break;
    html += "<span class=\"issue\"><b>" + issue_code_text(code) + "</b> " +
            escaped(spoken(bare_issue_name(code))) + "</span>";
  }
  if (codes.size() > kShown) html += "<span class=\"issue\">…</span>";
  html += "<small>" + plural(before.size(), "defect", "defects") + " before, " +
          grouped(after.size()) + " after";
  if (report.outcome != "delivered") return html + ", " + escaped(report.reason) + "</small>";
  html += " · " + plural(repairs, "repair", "repairs") + " · moved " +
          rounded(report.max_displacement_m, 4) + " m · deviates " +
          rounded(report.deviation_max_m, 3) + " m at most, " +
          rounded(report.deviation_mean_m, 3) + " m on average · ";
  if (report.volume_before_m3)
    html += rounded(*report.volume_before_m3, 1) + " m³ became " +
            rounded(report.volume_after_m3, 1) + " m³";
  else
    html += rounded(report.volume_after_m3, 1) + " m³";
  return html + "</small>";
}

Page page_of(const std::vector<DrawnFace>& before, const std::vector<DrawnFace>& after) {
  Box3 seen;  // x and screen y
  for (const auto* faces : {&before, &after})
    for (const DrawnFace& face : *faces)
      for (const auto& ring : face.rings)
        for (const auto& corner : ring) {
          const Point3 p = to_view(metres(corner));
          seen.add(Point3{p.x, screen_y(p), 0});
        }
  Page page;
  if (seen.is_empty()) return page;
  const double wide = std::max(seen.max.x - seen.min.x, 1e-3);
  const double high = std::max(seen.max.y - seen.min.y, 1e-3);
  page.scale = std::min((kPanelWidth - 2 * kMargin) / wide, (kPanelHeight - 2 * kMargin) / high);
  page.left = kPanelWidth / 2 - page.scale * (seen.min.x + seen.max.x) / 2;
  page.top = kPanelHeight / 2 + page.scale * (seen.min.y + seen.max.y) / 2;
  return page;
}

void append_marks(std::string& svg, const Page& page, const std::vector<Point3>& marks) {
  constexpr std::int64_t kApart_tenths = 60;  // nearer ones are one mark
  constexpr std::size_t kMaxMarks = 60;
  std::set<std::array<std::int64_t, 2>> places;
  for (const Point3& mark : marks) {
    const auto at = page.tenths(to_view(mark));
    if (places.size() == kMaxMarks) break;
    if (!places.insert({at[0] / kApart_tenths, at[1] / kApart_tenths}).second) continue;
    svg += "<circle cx=\"";
    append_tenths(svg, at[0]);
    svg += "\" cy=\"";
    append_tenths(svg, at[1]);
    svg += "\" r=\"4\"/>";
  }
}

}  // namespace

void Gallery::add(const BuildingReport& report, const BuildingBodies* bodies,
                  std::span<const SourceBody> sources) {
  if (sources.empty() || (bodies != nullptr && report.rung == "as_is")) return;
  const Rank rank{bodies != nullptr ? std::size_t{rung_style(report.rung)} : kStyles.size(),
                  std::max(report.deviation_max_m, report.max_displacement_m), changed_++};
  const auto worse = [](const Exhibit& a, const Exhibit& b) { return b.rank < a.rank; };
  if (exhibits_.size() == kMaxPictures && rank < exhibits_.front().rank) return;

  std::vector<Half> before, after;
  std::size_t faces = 0;
  for (const SourceBody& source : sources) {
    faces += source.shell.faces.size();
    before.push_back(
        {source.shell.points, source.shell.faces, face_findings(source.shell, source.issues)});
  }
  if (bodies != nullptr) {
    const std::set<FaceKey> known = keys_of(sources);
    for (const Body& body : bodies->bodies) {
      faces += body.mesh.faces.size();
      after.push_back({body.mesh.points, body.mesh.faces, change_styles(body, known)});
    }
  }
  if (faces > kMaxFaces) return;

  Exhibit exhibit{.rank = rank, .caption = caption_of(report), .label = report.gml_id};
  const int quarters = best_turn(before, after);
  draw(before, quarters, style::kInside, exhibit.before);
  draw(after, quarters, style::kOther, exhibit.after);
  for (const Issue& issue : all_issues(report, &PartReport::issues_before))
    if (issue.at) exhibit.marks.push_back(turned(*issue.at, quarters));
  exhibits_.push_back(std::move(exhibit));
  std::push_heap(exhibits_.begin(), exhibits_.end(), worse);
  if (exhibits_.size() <= kMaxPictures) return;
  std::pop_heap(exhibits_.begin(), exhibits_.end(), worse);
  exhibits_.pop_back();
}

std::string Gallery::section() const {
  if (exhibits_.empty()) return {};
  std::vector<const Exhibit*> shown;
  shown.reserve(exhibits_.size());
  for (const Exhibit& exhibit : exhibits_) shown.push_back(&exhibit);
  std::sort(shown.begin(), shown.end(),
            [](const Exhibit* a, const Exhibit* b) { return b->rank < a->rank; });

  Looks looks;
  for (const Exhibit* exhibit : shown) {
    looks.add(exhibit->before);
    looks.add(exhibit->after);
  }
  std::string html = "<section class=\"gallery\"><h2>Before and after</h2>\n<style>" +
                     looks.css(".ba", 0.5) + "</style><p class=\"meta\">";
  if (changed_ > shown.size())
    html += grouped(shown.size()) + " of " +
            plural(changed_, "changed building", "changed buildings") +
            ": those that changed most. ";
  html +=
      "Left what came, with places of defects marked and faces coloured by the gravest defect; "
      "right what is delivered, with what is not of the source tinted.</p><p class=\"keys\">";
  const auto key = [&html](const Style& entry, std::string_view text) {
    html += "<span><i style=\"background:";
    append_colour(html, entry.colour);
    html += "\"></i>";
    html += text;
    html += "</span>";
  };
  for (std::size_t i = style::kFirstFinding; i <= style::kLastFinding; ++i)
    key(kStyles[i], kStyles[i].meaning);
  key(kStyles[style::kInside], kStyles[style::kInside].meaning);
  key(kStyles[style::kNew], kStyles[style::kNew].meaning);
  html += "</p>\n<div class=\"grid\">\n";

  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Exhibit& exhibit = *shown[i];
    if (i == kShownAtOnce)
      html += "</div>\n<details><summary>" +
              plural(shown.size() - i, "more picture", "more pictures") +
              "</summary><div class=\"grid\">\n";
    Page page = page_of(exhibit.before, exhibit.after);
    html +=
        "<figure><svg class=\"ba\" viewBox=\"0 0 600 220\" role=\"img\"><title>before and after: " +
        escaped(exhibit.label) + "</title><g class=\"b\">";
    append_faces(html, page, exhibit.before);
    append_marks(html, page, exhibit.marks);
    html += "</g>";
    page.left += kPanelWidth;
    append_faces(html, page, exhibit.after);
    html += "<path class=\"cut\" d=\"M300 14V206\"/></svg><figcaption>" + exhibit.caption +
            "</figcaption></figure>\n";
  }
  html += shown.size() > kShownAtOnce ? "</div></details></section>\n" : "</div></section>\n";
  return html;
}

}  // namespace citymesh
