// Conformance class HTML: every resource is also a page that says what its JSON says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/rest/pages.h"
#include "tests/integration/rest/live_service.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ConformanceHtml : public LiveService {
 protected:
  /// A page that holds every text, number and link of the document.
  void expect_page_like_document(const std::string& target) {
    const auto whole = document(target);
    const auto answer = get(target, "text/html");
    EXPECT_EQ(answer.status, 200) << target;
    EXPECT_THAT(answer.headers.at("content-type"), StartsWith("text/html")) << target;
    EXPECT_THAT(answer.body, StartsWith("<!DOCTYPE html>"));
    EXPECT_THAT(answer.body, Not(HasSubstr("<script")));
    const auto leaves = whole.flatten();
    for (const auto& [pointer, value] : leaves.items()) {
      if (value.is_null() || value.is_structured() || value.is_boolean()) continue;
      if (pointer.ends_with("/rel") || pointer.ends_with("/type")) continue;  // for machines
      auto text = escape_html(value.is_string() ? value.get<std::string>() : value.dump());
      if (pointer.ends_with("/href")) text = "href=\"" + text + "\"";
      EXPECT_THAT(answer.body, HasSubstr(text)) << target << ' ' << pointer;
    }
  }
};

TEST_F(ConformanceHtml, PagesOfTheServiceSayWhatTheDocumentsSay) {
  for (const auto* target : {"/", "/conformance", "/processes", "/processes/echo",
                             "/processes/export-for-simulation", "/processes/validate"})
    expect_page_like_document(target);
}

TEST_F(ConformanceHtml, PagesOfJobsSayWhatTheDocumentsSay) {
  const auto done = execute({{"inputs", {{"text", "a"}}}}, "respond-async").headers.at("location");
  ended(done);
  const auto failed = send("POST", "/processes/heal/execution", R"({"inputs":{}})",
                           "application/json", "Prefer: respond-async\r\n")
                          .headers.at("location");
  ended(failed);
  for (const auto& target : {std::string("/jobs"), std::string("/jobs?limit=1"), done, failed})
    expect_page_like_document(path_of(target));
  expect_page_like_document(path_of(done) + "/results");
}

TEST_F(ConformanceHtml, ProblemsAndDismissalsHavePagesToo) {
  const auto missing = get("/jobs/nothing", "text/html");
  EXPECT_EQ(missing.status, 404);
  EXPECT_THAT(missing.headers.at("content-type"), StartsWith("text/html"));
  const auto job =
      execute({{"inputs", {{"text", "a"}, {"pause", 60}}}}, "respond-async").headers.at("location");
  const auto dismissed = send("DELETE", job, {}, "text/html");
  EXPECT_EQ(dismissed.status, 200);
  EXPECT_THAT(dismissed.headers.at("content-type"), StartsWith("text/html"));
  EXPECT_THAT(dismissed.body, HasSubstr("dismissed"));
}

}  // namespace
}  // namespace citymesh
