#include "services/rest/cors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rest/rest_api.h"

namespace citymesh {
namespace {

using testing::HasSubstr;

constexpr auto* kPortal = "https://portal.example";

class RestCors : public RestApi {
 protected:
  void allow(std::string origins) {
    api_.emplace(service_.jobs(), service_.metrics(),
                 ApiOptions{.cors_allow_origin = std::move(origins)});
  }
  Response from(const std::string& origin, std::string method, std::string target,
                std::string body = {}) {
    Request request{std::move(method), std::move(target), {}, std::move(body)};
    request.headers.set("Host", "citymesh.test:8080");
    if (!origin.empty()) request.headers.set("Origin", origin);
    return api_->handle(request);
  }
  static std::string allowed(const Response& response) {
    return response.headers.get("Access-Control-Allow-Origin");
  }
  std::size_t jobs() { return document(from({}, "GET", "/jobs"))["jobs"].size(); }

  std::optional<Api> api_;
};

TEST_F(RestCors, PagesOfOtherOriginsNeitherReadNorChangeAnythingUnlessTheyMay) {
  allow({});
  EXPECT_EQ(allowed(from(kPortal, "GET", "/jobs")), "");
  const auto preflight = from(kPortal, "OPTIONS", kExecution);
  EXPECT_EQ(preflight.status, 204);
  EXPECT_EQ(allowed(preflight), "");
  EXPECT_FALSE(preflight.headers.has("Access-Control-Allow-Methods"));
  // A POST without Content-Type is sent by browsers without asking before.
  for (const auto* origin : {kPortal, "null", "http://citymesh.test", "http://citymesh.test:80801"})
    EXPECT_THAT(detail(from(origin, "POST", kExecution, kBox), 403), HasSubstr(origin));
  EXPECT_EQ(jobs(), 0u);
  const auto job = submit();
  EXPECT_EQ(from(kPortal, "DELETE", "/jobs/" + job).status, 403);
  EXPECT_EQ(document(from({}, "GET", "/jobs/" + job))["status"], "accepted");
}

TEST_F(RestCors, PagesOfTheServiceAndClientsThatAreNoBrowsersNeedNoPermission) {
  allow({});
  for (const auto* origin : {"", "http://citymesh.test:8080", "https://CITYMESH.test:8080"})
    EXPECT_EQ(from(origin, "POST", kExecution, kBox).status, 201) << origin;
}

TEST_F(RestCors, NamedOriginsMayUseTheWholeJobCycle) {
  allow("http://localhost:3000, https://portal.example");
  for (const auto* origin : {"http://localhost:3000", kPortal}) {
    const auto created = from(origin, "POST", kExecution, kBox);
    EXPECT_EQ(created.status, 201);
    EXPECT_EQ(allowed(created), origin);
    for (const auto* name : {"Location", "Link", "Preference-Applied", "Content-Disposition",
                             "ETag", "Content-Range", "Accept-Ranges"})
      EXPECT_THAT(created.headers.get("Access-Control-Expose-Headers"), HasSubstr(name));
    const auto preflight = from(origin, "OPTIONS", kExecution);
    EXPECT_EQ(preflight.status, 204);
    EXPECT_EQ(allowed(preflight), origin);
    EXPECT_EQ(preflight.headers.get("Access-Control-Allow-Methods"), "POST, OPTIONS");
    for (const auto* name :
         {"Content-Type", "Range", "If-Range", "If-None-Match", "Prefer", "X-API-Key"})
      EXPECT_THAT(preflight.headers.get("Access-Control-Allow-Headers"), HasSubstr(name));
  }
  for (const auto* origin : {"https://portal.example.evil.example", "http://portal.example",
                             "https://portal.example, http://localhost:3000", "*"}) {
    EXPECT_EQ(allowed(from(origin, "GET", "/")), "");
    EXPECT_EQ(from(origin, "POST", kExecution, kBox).status, 403);
  }
}

TEST_F(RestCors, CachesAreToldThatAnswersDifferByOrigin) {
  allow(kPortal);
  for (const auto* origin : {kPortal, "https://other.example", ""})
    EXPECT_THAT(from(origin, "GET", "/").headers.get("Vary"), HasSubstr("Origin"));
}

TEST_F(RestCors, AStarLetsEveryPageIn) {
  allow("*");
  for (const auto* origin : {kPortal, "null", ""}) {
    EXPECT_EQ(allowed(from(origin, "GET", "/")), "*");
    EXPECT_EQ(from(origin, "POST", kExecution, kBox).status, 201);
  }
  EXPECT_EQ(from(kPortal, "GET", "/").headers.get("Vary"), "Accept");
}

}  // namespace
}  // namespace citymesh
