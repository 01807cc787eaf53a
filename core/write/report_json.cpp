#include "core/write/report_json.h"

#include "core/write/text.h"
#include "core/write/writers.h"

namespace citymesh {
namespace {

/// Writes the members of one object with their commas.
class Members {
 public:
  Members(std::string& json, std::string_view separator) : json_(json), separator_(separator) {}

  std::string& key(std::string_view name) {
    if (!first_) json_ += separator_;
    first_ = false;
    append_json_string(json_, name);
    json_ += ": ";
    return json_;
  }
  void text(std::string_view name, std::string_view value) { append_json_string(key(name), value); }
  /// null where there is no text
  void optional(std::string_view name, std::string_view value) {
    if (value.empty()) {
      key(name) += "null";
    } else {
      text(name, value);
    }
  }
  void number(std::string_view name, double value) { append_number(key(name), value); }
  void count(std::string_view name, std::uint64_t value) {
    append_integer(key(name), static_cast<std::int64_t>(value));
  }

 private:
  std::string& json_;
  std::string_view separator_;
  bool first_ = true;
};

void append_point(std::string& json, const Point3& p) {
  json += '[';
  append_number(json, p.x, 4);
  json += ", ";
  append_number(json, p.y, 4);
  json += ", ";
  append_number(json, p.z, 4);
  json += ']';
}

void append_place(Members& members, const std::optional<Point3>& at) {
  if (at) append_point(members.key("at"), *at);
}

void append_part_members(Members& members, const PartReport& part) {
  members.text("gml_id", part.gml_id);
  members.optional("name", part.name);
  members.text("kind", to_string(part.kind));
  members.text("outcome", part.outcome);
  members.optional("merged_into", part.merged_into);
  members.optional("reason", part.reason);
  members.optional("lod", part.lod);
  members.optional("lane", part.lane);
  members.optional("rung", part.rung);
  append_issues(members.key("issues_before"), part.issues_before);
  append_issues(members.key("issues_after"), part.issues_after);
  std::string& json = members.key("repairs");
  json += '[';
  for (std::size_t i = 0; i < part.repairs.size(); ++i) {
    json += i == 0 ? "{" : ", {";
    Members repair(json, ", ");
    repair.text("kind", part.repairs[i].kind);
    repair.text("where", part.repairs[i].where);
    repair.number("displacement_m", part.repairs[i].displacement_m);
    append_place(repair, part.repairs[i].at);
    json += '}';
  }
  json += ']';
  members.number("max_displacement_m", part.max_displacement_m);
  members.number("deviation_max_m", part.deviation_max_m);
  members.number("deviation_mean_m", part.deviation_mean_m);
  if (part.volume_before_m3) {
    members.number("volume_before_m3", *part.volume_before_m3);
  } else {
    members.key("volume_before_m3") += "null";
  }
  members.number("volume_after_m3", part.volume_after_m3);
  if (part.volume_before_m3 && part.outcome == "delivered") {
    members.number("volume_change_m3", part.volume_after_m3 - *part.volume_before_m3);
  } else {
    members.key("volume_change_m3") += "null";
  }
  members.count("triangles", part.triangles);
}

void append_counts(Members& members, const Counts& counts) {
  members.count("requested", counts.requested);
  members.count("delivered", counts.delivered);
  members.count("merged", counts.merged);
  members.count("dropped", counts.dropped);
}

void append_histogram(std::string& json,
                      const std::vector<std::pair<std::string, std::uint64_t>>& histogram) {
  json += '{';
  Members members(json, ", ");
  for (const auto& [name, count] : histogram) members.count(name, count);
  json += '}';
}

constexpr std::string_view kNextLine = ",\n  ";

}  // namespace

std::string_view bare_issue_name(int code) {
  const std::string_view name = issue_name(code);
  return name.substr(name.find(' ') + 1);  // the table gives "302 SHELL_NOT_CLOSED"
}

void append_issues(std::string& json, std::span<const Issue> issues) {
  json += '[';
  for (std::size_t i = 0; i < issues.size(); ++i) {
    json += i == 0 ? "{" : ", {";
    Members members(json, ", ");
    members.text("code", issue_code_text(issues[i].code));
    members.text("name", bare_issue_name(issues[i].code));
    members.text("where", issues[i].where);
    members.number("measured", issues[i].measured);
    append_place(members, issues[i].at);
    if (issues[i].assembled) members.key("assembled") += "true";
    json += '}';
  }
  json += ']';
}

void append_report_head(std::string& json, const RunReport& report) {
  json += "{\n  ";
  Members members(json, kNextLine);
  members.text("process", report.process);
  members.text("version", report.version);
  members.key("options") += report.options_json.empty() ? "{}" : report.options_json;
  members.optional("crs", report.crs.id);
  members.optional("vertical_crs", report.vertical_crs);
  std::string& sources = members.key("source_crs");
  sources += '[';
  for (std::size_t i = 0; i < report.source_crs.size(); ++i) {
    if (i > 0) sources += ", ";
    append_json_string(sources, report.source_crs[i]);
  }
  sources += ']';
  append_point(members.key("origin"), report.origin);
  members.text("unit", "metre");
  members.text("axes", kAxes);

  members.key("inputs") += '[';
  for (std::size_t i = 0; i < report.inputs.size(); ++i) {
    json += i == 0 ? "\n    {" : ",\n    {";
    const InputReport& input = report.inputs[i];
    Members entry(json, ", ");
    entry.text("file", input.file);
    entry.text("format", input.format);
    entry.text("state", input.state);
    entry.optional("message", input.message);
    entry.optional("crs", input.crs);
    entry.count("buildings", input.buildings);
    json += '}';
  }
  json += report.inputs.empty() ? "]" : "\n  ]";

  members.key("counts") += '{';
  Members counts(json, ", ");
  append_counts(counts, report.counts);
  counts.key("parts") += '{';
  Members parts(json, ", ");
  append_counts(parts, report.part_counts);
  json += "}}";

  append_histogram(members.key("rungs"), report.rungs);
  append_histogram(members.key("drop_reasons"), report.drop_reasons);
  members.key("warnings") += '[';
  for (std::size_t i = 0; i < report.warnings.size(); ++i) {
    json += i == 0 ? "\n    " : ",\n    ";
    append_json_string(json, report.warnings[i]);
  }
  json += report.warnings.empty() ? "]" : "\n  ]";
  members.key("buildings") += '[';
}

void append_building_json(std::string& json, const BuildingReport& building) {
  json += '{';
  Members members(json, ", ");
  append_part_members(members, building);
  members.key("parts") += '[';
  for (std::size_t i = 0; i < building.parts.size(); ++i) {
    json += i == 0 ? "{" : ", {";
    Members part(json, ", ");
    append_part_members(part, building.parts[i]);
    json += '}';
  }
  json += "]}";
}

void append_report_tail(std::string& json, const RunReport& report) {
  json += "],\n  \"mesh\": {";
  Members mesh(json, ", ");
  mesh.count("bodies", report.bodies);
  mesh.count("points", report.points);
  mesh.count("triangles", report.triangles);
  if (report.contacts)
    mesh.count("contacts", *report.contacts);
  else
    mesh.key("contacts") += "null";
  mesh.number("volume_m3", report.volume_m3);
  mesh.number("area_m2", report.area_m2);
  mesh.number("min_edge_m", report.min_edge_m);
  mesh.number("min_angle_deg", report.min_angle_deg);
  if (report.extent.is_empty()) {
    mesh.key("extent") += "null";
  } else {
    mesh.key("extent") += '[';
    append_point(json, report.extent.min);
    json += ", ";
    append_point(json, report.extent.max);
    json += ']';
  }
  json += "}\n}\n";
}

}  // namespace citymesh
