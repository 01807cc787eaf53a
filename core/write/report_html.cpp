#include "core/write/report_html.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/write/html.h"
#include "core/write/report_assets.h"
#include "core/write/report_json.h"
#include "core/write/styles.h"
#include "core/write/text.h"
#include "core/write/write.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

std::string percent(std::uint64_t part, std::uint64_t whole) {
  std::string out;
  append_number(
      out, whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole), 2);
  return out + '%';
}

/// "export-for-simulation" as "Export for simulation".
std::string process_title(std::string_view process) {
  std::string title(process);
  std::replace(title.begin(), title.end(), '-', ' ');
  if (!title.empty() && title[0] >= 'a' && title[0] <= 'z')
    title[0] = static_cast<char>(title[0] - 32);
  return title.empty() ? "Report" : title;
}

std::string_view reason_meaning(std::string_view reason) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kMeanings{
      {{"no_geometry", "the source has no geometry of the wanted levels of detail"},
       {"no_height", "nothing tells how high it is"},
       {"duplicate_id", "the id was there before"},
       {"not_healed", "no allowed rung of the ladder passed the delivery gates"},
       {"building_dropped", "part of a building that was dropped"}}};
  for (const auto& [name, meaning] : kMeanings)
    if (name == reason) return meaning;
  return {};
}

void append_number_card(std::string& html, std::uint64_t number, std::string_view label) {
  html += number == 0 ? "<div class=\"zero\"><b>" : "<div><b>";
  html += grouped(number) + "</b><span>" + std::string(label) + "</span></div>\n";
}

void append_bar(std::string& html, std::string_view name, std::string_view meaning,
                std::uint64_t count, std::uint64_t most, std::string_view colour) {
  html += "<dt>" + escaped(name);
  if (!meaning.empty()) html += "<small>" + escaped(meaning) + "</small>";
  html += "</dt><dd class=\"n\">" + grouped(count) +
          "</dd><dd class=\"bar\"><i style=\"width:" + percent(count, most);
  if (!colour.empty()) html += ";background:" + std::string(colour);
  html += "\"></i></dd>\n";
}

std::string option_text(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_array()) {
    std::string text;
    for (const auto& entry : value) text += (text.empty() ? "" : ", ") + option_text(entry);
    return text;
  }
  if (value.is_object()) {
    std::string text;
    for (const auto& [key, entry] : value.items())
      text += (text.empty() ? "" : "; ") + key + " " + option_text(entry);
    return text;
  }
  if (value.is_null()) return {};
  return value.dump();
}

nlohmann::ordered_json parsed_options(const RunReport& report) {
  auto options = nlohmann::ordered_json::parse(report.options_json, nullptr, false);
  return options.is_object() ? options : nlohmann::ordered_json::object();
}

void append_summary(std::string& html, const RunReport& report, const ReportFindings& findings,
                    bool only_checked) {
  const Counts& counts = report.counts;
  html += "<section aria-label=\"Summary\"><div class=\"numbers\">\n";
  if (only_checked) {
    append_number_card(html, findings.buildings, "checked");
    append_number_card(html, findings.buildings - findings.buildings_with_issues,
                       "without defects");
    append_number_card(html, findings.buildings_with_issues, "with defects");
    append_number_card(html, counts.dropped, "could not be checked");
    html += "</div>\n</section>\n";
    return;
  }
  append_number_card(html, counts.requested, "requested");
  append_number_card(html, counts.delivered, "delivered");
  append_number_card(html, counts.merged, "merged into another");
  append_number_card(html, counts.dropped, "dropped");
  html += "</div>\n<div class=\"share\" aria-hidden=\"true\">";
  const auto share = [&](std::uint64_t count, std::string_view colour, std::string_view label) {
    if (count == 0) return;
    html += "<i style=\"flex:" + std::to_string(count) + ";background:" + std::string(colour) +
            "\" title=\"" + escaped(label) + ' ' + grouped(count) + "\"></i>";
  };
  for (const auto& [rung, count] : report.rungs) share(count, css_colour(rung), rung);
  share(counts.merged, "#98a4b3", "merged");
  share(counts.dropped, "var(--bad)", "dropped");
  html += "</div>\n<p class=\"facts\">";
  const auto fact = [&html](std::string_view label, const std::string& value) {
    html += "<span>" + std::string(label) + " <b>" + value + "</b></span>\n";
  };
  fact("bodies", grouped(report.bodies));
  fact("triangles", grouped(report.triangles));
  fact("volume", rounded(report.volume_m3, 1) + " m³");
  fact("surface", rounded(report.area_m2, 1) + " m²");
  if (report.bodies > 0) {
    fact("shortest edge", rounded(report.min_edge_m, 4) + " m");
    fact("smallest angle", rounded(report.min_angle_deg, 3) + "°");
  }
  if (report.contacts) fact("contacts between bodies", grouped(*report.contacts));
  if (report.part_counts.requested > 0)
    fact("parts", grouped(report.part_counts.delivered) + " of " +
                      grouped(report.part_counts.requested) + " delivered");
  html += "</p>\n</section>\n";
}

void append_charts(std::string& html, const RunReport& report, const ReportFindings& findings) {
  const auto most = [](const auto& histogram) {
    std::uint64_t largest = 1;
    for (const auto& entry : histogram) largest = std::max<std::uint64_t>(largest, entry.second);
    return largest;
  };
  html += "<div class=\"pair\">\n";
  if (!report.rungs.empty()) {
    html += "<section><h2>How the delivered buildings got there</h2><dl class=\"bars\">\n";
    for (const auto& [rung, count] : report.rungs)
      append_bar(html, rung, kStyles[rung_style(rung)].meaning, count, most(report.rungs),
                 css_colour(rung));
    html += "</dl></section>\n";
  }
  html += "<section><h2>Defects found in the source</h2>\n";
  if (findings.buildings_by_issue.empty()) {
    html += "<p class=\"none\">None.</p></section>\n";
  } else {
    std::vector<std::pair<int, std::uint64_t>> issues(findings.buildings_by_issue.begin(),
                                                      findings.buildings_by_issue.end());
    std::stable_sort(issues.begin(), issues.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    constexpr std::size_t kShown = 8;
    html += "<dl class=\"bars\">\n";
    for (std::size_t i = 0; i < std::min(kShown, issues.size()); ++i)
      append_bar(html, issue_code_text(issues[i].first), spoken(bare_issue_name(issues[i].first)),
                 issues[i].second, most(issues), {});
    html += "</dl><p class=\"meta\">Buildings that have the defect";
    if (issues.size() > kShown)
      html += "; " + plural(issues.size() - kShown, "rarer defect is", "rarer defects are") +
              " in the table";
    html += ".</p></section>\n";
  }
  if (!report.drop_reasons.empty()) {
    html += "<section><h2>Why buildings were dropped</h2><dl class=\"bars\">\n";
    for (const auto& [reason, count] : report.drop_reasons)
      append_bar(html, reason, reason_meaning(reason), count, most(report.drop_reasons),
                 "var(--bad)");
    html += "</dl></section>\n";
  }
  html += "</div>\n";
}

void append_asked(std::string& html, const RunReport& report,
                  const nlohmann::ordered_json& options) {
  html += "<div class=\"pair\">\n<section><h2>What was asked</h2><dl class=\"asked\">\n";
  for (const auto& [name, value] : options.items()) {
    const std::string text = option_text(value);
    html += "<dt>" + escaped(name) + "</dt><dd>";
    html += text.empty() ? "<span class=\"none\">not set</span>" : escaped(text);
    html += "</dd>\n";
  }
  html += "</dl></section>\n<section><h2>What was read</h2><ul class=\"plain\">\n";
  for (const InputReport& input : report.inputs) {
    html += "<li><b>" + escaped(input.file) + "</b> <span class=\"none\">" + escaped(input.format);
    if (!input.crs.empty()) html += ", " + escaped(input.crs);
    html += "</span><br>";
    if (input.message.empty()) {
      html += plural(input.buildings, "building", "buildings");
    } else {
      html += escaped(input.state) + ": " + escaped(input.message);
    }
    html += "</li>\n";
  }
  if (report.inputs.empty()) html += "<li class=\"none\">Nothing.</li>\n";
  html += "</ul></section>\n<section><h2>Files</h2><ul class=\"plain\">\n";
  const auto file = [&html](std::string_view name, std::string_view what) {
    html += "<li><a href=\"" + escaped(name) + "\" download>" + escaped(name) +
            "</a> <span class=\"none\">" + escaped(what) + "</span></li>\n";
  };
  if (options.contains("formats") && options["formats"].is_array())
    for (const auto& key : options["formats"])
      if (const Format* format = key.is_string() ? find_format(key.get<std::string>()) : nullptr) {
        file(format->file_name, format->media_type);
        if (!format->sidecar.empty()) file(format->sidecar, "names of its triangle ranges");
      }
  file("report.json", "all of this for programs");
  file("picture.svg", "the picture");
  if (report.process == "validate" || report.process == "heal")
    file("errors.glb", "the buildings as they came, defects coloured");
  file("run.json", "timings");
  html += "</ul><p class=\"meta\">Coordinates in the files are metres from the origin, axes " +
          std::string(kAxes) + ". Add the origin for coordinates in " +
          (report.crs.id.empty() ? "the source's frame" : escaped(report.crs.id)) +
          ".</p></section>\n</div>\n";
}

/// Issues of a building and its parts by code, with how often and the first place.
struct IssueGroup {
  int code = 0;
  std::uint64_t count = 0;
  const Issue* first = nullptr;
};

std::vector<IssueGroup> grouped_issues(const BuildingReport& building) {
  std::vector<IssueGroup> groups;
  const auto add = [&groups](const std::vector<Issue>& issues) {
    for (const Issue& issue : issues) {
      const auto same =
          std::find_if(groups.begin(), groups.end(),
                       [&issue](const IssueGroup& group) { return group.code == issue.code; });
      if (same != groups.end()) {
        ++same->count;
      } else {
        groups.push_back({issue.code, 1, &issue});
      }
    }
  };
  add(building.issues_before);
  for (const PartReport& part : building.parts) add(part.issues_before);
  std::sort(groups.begin(), groups.end(),
            [](const IssueGroup& a, const IssueGroup& b) { return a.code < b.code; });
  return groups;
}

void append_value_cell(std::string& html, double value, const std::string& text) {
  html += "<td class=\"num\" data-v=\"";
  append_number(html, std::isfinite(value) ? value : 0.0, 6);
  html += "\">" + text + "</td>";
}

}  // namespace

void ReportFindings::add(const BuildingReport& building) {
  ++buildings;
  const auto groups = grouped_issues(building);
  if (!groups.empty()) ++buildings_with_issues;
  for (const IssueGroup& group : groups) ++buildings_by_issue[group.code];
}

void append_page_head(std::string& html, const RunReport& report, const ReportFindings& findings,
                      std::string_view picture_svg, std::string_view gallery) {
  const std::string title = process_title(report.process);
  const bool only_checked = report.process == "validate";
  const Counts& counts = report.counts;
  html +=
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>" +
      escaped(title) + " – citymesh report</title>\n<style>" + std::string(kReportStyle) +
      "</style></head><body>\n<header><h1>" + escaped(title) + "</h1>\n<p class=\"lead\">";
  if (only_checked) {
    html += plural(findings.buildings, "building was", "buildings were") + " checked; " +
            (findings.buildings_with_issues == 0
                 ? std::string("no defects were found.")
                 : plural(findings.buildings_with_issues, "has", "have") + " defects.");
  } else if (counts.requested == 0) {
    html += "No building was selected.";
  } else {
    html += grouped(counts.delivered) + " of " +
            plural(counts.requested, "requested building is", "requested buildings are") +
            " delivered as closed meshes";
    if (counts.merged > 0) html += ", " + grouped(counts.merged) + " merged into others";
    html += counts.dropped > 0 ? ", " + grouped(counts.dropped) + " dropped with a reason." : ".";
  }
  html += "</p>\n<p class=\"meta\">citymesh " + escaped(report.version);
  if (!report.crs.id.empty()) html += " · " + escaped(report.crs.id);
  html += " · origin ";
  append_number(html, report.origin.x, 4);
  html += ", ";
  append_number(html, report.origin.y, 4);
  html += ", ";
  append_number(html, report.origin.z, 4);
  html += " m</p></header>\n<main>\n";

  append_summary(html, report, findings, only_checked);
  if (!report.warnings.empty()) {
    html += "<section class=\"warnings\"><h2>Warnings</h2><ul>\n";
    for (const std::string& warning : report.warnings)
      html += "<li>" + escaped(warning) + "</li>\n";
    html += "</ul></section>\n";
  }
  html += "<figure>\n";
  html += picture_svg;
  html += "</figure>\n";
  html += gallery;
  append_charts(html, report, findings);
  append_asked(html, report, parsed_options(report));

  html += "<section class=\"table\"><h2>Buildings</h2>\n";
  if (findings.buildings > kMaxHtmlRows)
    html += "<p class=\"meta\">The first " + grouped(kMaxHtmlRows) + " of " +
            grouped(findings.buildings) + " buildings; report.json has all.</p>\n";
  html +=
      "<div class=\"controls\" hidden><input type=\"search\" id=\"search\" placeholder=\"Find an "
      "id, "
      "a defect, a reason\" aria-label=\"Filter buildings\">\n<select id=\"rung\" "
      "aria-label=\"Outcome\"><option value=\"\">every outcome</option></select>\n<label><input "
      "type=\"checkbox\" id=\"defects\"> with defects</label><output "
      "id=\"shown\"></output></div>\n<div class=\"scroll\"><table id=\"buildings\"><thead><tr>"
      "<th><button>Building</button></th><th><button>Outcome</button></th>"
      "<th><button>LoD, lane</button></th><th><button>Defects in the source</button></th>"
      "<th class=\"num\"><button>Moved (m)</button></th><th class=\"num\"><button>Volume "
      "(m³)</button></th><th class=\"num\"><button>Triangles</button></th></tr></thead><tbody>\n";
}

void append_row(std::string& html, const BuildingReport& building, bool only_checked) {
  const auto groups = grouped_issues(building);
  const bool delivered = building.outcome == "delivered", made = delivered && !only_checked;
  std::string kind = delivered && !building.rung.empty() ? building.rung : building.outcome;
  std::string shown = rung_chip(building.rung, building.outcome);
  if (delivered && only_checked) {
    std::uint8_t gravest = style::kSound;
    for (const IssueGroup& group : groups) gravest = std::max(gravest, finding_style(group.code));
    kind = groups.empty() ? "sound" : "defective";
    shown = chip(kind, kStyles[gravest]);
  }
  html += "<tr data-kind=\"" + escaped(kind) + "\" data-issues=\"" + std::to_string(groups.size()) +
          "\"><td><span class=\"id\">" + escaped(building.gml_id) + "</span>";
  if (!building.name.empty() && building.name != building.gml_id)
    html += "<small>" + escaped(building.name) + "</small>";
  if (!building.parts.empty())
    html += "<small>" + plural(building.parts.size(), "part", "parts") + "</small>";
  html += "</td><td>" + shown;
  if (!building.reason.empty())
    html += "<small class=\"bad\">" + escaped(building.reason) + "</small>";
  if (!building.merged_into.empty())
    html += "<small>into " + escaped(building.merged_into) + "</small>";
  html += "</td><td>" + escaped(building.lod);
  if (!building.lane.empty()) html += " <span class=\"none\">" + escaped(building.lane) + "</span>";
  html += "</td><td>";
  for (const IssueGroup& group : groups) {
    const std::string code = issue_code_text(group.code);
    std::string measured;
    append_number(measured, group.first->measured, 6);
    html += "<abbr class=\"issue\" title=\"" + escaped(code) + ' ' +
            escaped(bare_issue_name(group.code)) + ": " + plural(group.count, "place", "places") +
            ", first at " + escaped(group.first->where);
    if (group.first->measured != 0) html += ", measured " + measured;
    html += "\"><b>" + escaped(code) + "</b> " + escaped(spoken(bare_issue_name(group.code)));
    if (group.count > 1) html += " ×" + grouped(group.count);
    html += "</abbr>";
  }
  html += "</td>";
  append_value_cell(html, building.max_displacement_m,
                    made ? rounded(building.max_displacement_m, 4) : std::string());
  append_value_cell(html, building.volume_after_m3,
                    made ? rounded(building.volume_after_m3, 1) : std::string());
  append_value_cell(html, static_cast<double>(building.triangles),
                    delivered ? grouped(building.triangles) : std::string());
  html += "</tr>\n";
}

void append_page_tail(std::string& html) {
  html +=
      "</tbody></table></div></section>\n</main>\n<footer>Delivered means: closed, 2-manifold, "
      "oriented outwards, free of self-intersections and degenerate triangles, judged on what was "
      "read back after writing. Defects carry the numbers and names of val3dity; own ones start "
      "at C101.</footer>\n<script>" +
      std::string(kReportScript) + "</script>\n</body></html>\n";
}

}  // namespace citymesh
