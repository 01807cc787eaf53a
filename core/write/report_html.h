#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "core/citymodel/report.h"

namespace citymesh {

/// What the page counts while buildings pass.
struct ReportFindings {
  std::uint64_t buildings = 0;
  std::uint64_t buildings_with_issues = 0;
  std::map<int, std::uint64_t> buildings_by_issue{};  ///< issue code → buildings that have it

  void add(const BuildingReport& building);
};

inline constexpr std::uint64_t kMaxHtmlRows = 5000;

// report.html in three pieces: the page up to the table's rows, with the picture and the gallery (a
// section, or nothing); a row per building (at most kMaxHtmlRows); the rest. All texts of the data
// are escaped; nothing is loaded from elsewhere.
void append_page_head(std::string& html, const RunReport& report, const ReportFindings& findings,
                      std::string_view picture_svg, std::string_view gallery);
void append_row(std::string& html, const BuildingReport& building, bool only_checked);
void append_page_tail(std::string& html);

}  // namespace citymesh
