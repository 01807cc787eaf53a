#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/citymodel/report.h"

namespace citymesh {

// report.json in three pieces: head, one line per building, tail.
void append_report_head(std::string& json, const RunReport& report);
void append_building_json(std::string& json, const BuildingReport& building);
void append_report_tail(std::string& json, const RunReport& report);

/// The list of them as it stands in report.json.
void append_issues(std::string& json, std::span<const Issue> issues);

/// "SHELL_NOT_CLOSED" of issue 302.
std::string_view bare_issue_name(int code);

}  // namespace citymesh
