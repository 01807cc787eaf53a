// The pages say what the tables in the code say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/citymodel/issue.h"
#include "services/offer/offer.h"

namespace citymesh {
namespace {

using Cells = std::vector<std::string>;

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" ");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" ") - begin + 1));
}

Cells cells_of(std::string_view row) {
  Cells cells;
  row.remove_prefix(1);
  for (auto end = row.find('|'); end != std::string_view::npos; end = row.find('|')) {
    cells.push_back(trimmed(row.substr(0, end)));
    row.remove_prefix(end + 1);
  }
  return cells;
}

/// Rows of the table whose first column is `header`, by their first cell; backticks and the targets
/// of links are dropped there.
std::map<std::string, Cells> table(const std::filesystem::path& page, const std::string& header) {
  std::ifstream file(page);
  EXPECT_TRUE(file.is_open()) << page;
  std::map<std::string, Cells> rows;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("|")) {
      inside = false;
      continue;
    }
    auto cells = cells_of(line);
    if (cells.empty()) continue;
    if (cells[0].starts_with("[")) cells[0] = cells[0].substr(1, cells[0].find(']') - 1);
    if (cells[0] == header) {
      inside = true;
    } else if (inside && !cells[0].starts_with("-")) {
      std::erase(cells[0], '`');
      rows[cells[0]] = cells;
    }
  }
  return rows;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::string values_of(const OptionSpec& option) {
  std::string text;
  for (const auto choice : option.choices)
    text += (text.empty() ? "`" : ", `") + std::string(choice) + "`";
  if (option.minimum != option.maximum)
    text = number(option.minimum) + " … " + number(option.maximum);
  return text;
}

TEST(Docs, EveryProcessHasAPageWithItsInputsAndTheirDefaults) {
  for (const auto& process : offered_processes()) {
    const auto page =
        std::filesystem::path(CITYMESH_DOCS) / "processes" / (std::string(process.id) + ".md");
    const auto rows = table(page, "name");
    EXPECT_EQ(rows.size(), process.inputs.size()) << page;
    for (const auto& option : process.inputs) {
      const auto row = rows.find(std::string(option.name));
      ASSERT_NE(row, rows.end()) << page << " has no row for " << option.name;
      ASSERT_GE(row->second.size(), 5U) << option.name;
      EXPECT_EQ(row->second[1], to_string(option.kind)) << page << ", " << option.name;
      EXPECT_EQ(row->second[2], "`" + std::string(option.default_json) + "`")
          << page << ", " << option.name;
      EXPECT_EQ(row->second[3], values_of(option)) << page << ", " << option.name;
    }
  }
}

TEST(Docs, TheListOfProcessesIsComplete) {
  const auto rows =
      table(std::filesystem::path(CITYMESH_DOCS) / "processes" / "README.md", "process");
  EXPECT_EQ(rows.size(), offered_processes().size());
}

TEST(Docs, EveryIssueCodeHasAPage) {
  for (int code = 1; code < kOwnIssueBase + 1000; ++code) {
    const auto name = issue_name(code);
    if (name == "UNKNOWN_ISSUE") continue;
    const auto page =
        std::filesystem::path(CITYMESH_DOCS) / "issues" / (issue_code_text(code) + ".md");
    std::ifstream file(page);
    ASSERT_TRUE(file.is_open()) << page;
    std::string title;
    std::getline(file, title);
    EXPECT_EQ(title, "# " + std::string(name));
  }
}

TEST(Docs, EveryIssueCodeIsOnTheIndexPage) {
  const auto rows = table(std::filesystem::path(CITYMESH_DOCS) / "issues" / "README.md", "code");
  for (int code = 1; code < kOwnIssueBase + 1000; ++code) {
    const auto name = issue_name(code);
    if (name == "UNKNOWN_ISSUE") continue;
    const auto row = rows.find(issue_code_text(code));
    ASSERT_NE(row, rows.end()) << "docs/issues/README.md has no row for " << name;
    EXPECT_EQ(issue_code_text(code) + " " + row->second.at(1), name);
  }
  for (const auto& [code, cells] : rows) {
    const int number =
        code.starts_with("C") ? kOwnIssueBase + std::stoi(code.substr(1)) : std::stoi(code);
    EXPECT_NE(issue_name(number), "UNKNOWN_ISSUE") << code;
  }
}

}  // namespace
}  // namespace citymesh
