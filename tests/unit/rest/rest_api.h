#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/rest/api.h"
#include "tests/unit/rest/job_service.h"

namespace citymesh {

inline constexpr auto* kBox = R"({"inputs":{"bbox":{"bbox":[13.4,52.5,13.41,52.51]}}})";
inline constexpr auto* kExecution = "/processes/export-for-simulation/execution";
inline const std::string kExceptions =
    "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/";

class RestApi : public ::testing::Test {
 protected:
  using Fields = std::vector<std::pair<std::string, std::string>>;

  Response send(std::string method, std::string target, std::string body = {}, Fields fields = {}) {
    Request request{std::move(method), std::move(target), {}, std::move(body)};
    request.headers.set("Host", "citymesh.test:8080");
    if (!request.body.empty()) request.headers.set("Content-Type", "application/json");
    for (auto& [name, value] : fields) request.headers.set(name, value);
    return api_.handle(request);
  }
  Response get(std::string target, Fields fields = {}) {
    return send("GET", std::move(target), {}, std::move(fields));
  }
  static std::string text(const Response& response) { return must(body_text(response)); }
  static nlohmann::json document(const Response& response) {
    return nlohmann::json::parse(text(response));
  }

  /// The problem of an answer, after which the next request must still work.
  nlohmann::json problem(const Response& response, int status) {
    EXPECT_EQ(response.status, status);
    EXPECT_EQ(response.headers.get("Content-Type"), "application/problem+json");
    EXPECT_EQ(get("/processes").status, 200);
    auto parsed = document(response);
    EXPECT_EQ(parsed["status"], status);
    EXPECT_TRUE(parsed["type"].is_string());
    return parsed;
  }
  std::string detail(const Response& response, int status) {
    return problem(response, status)["detail"].get<std::string>();
  }

  static std::vector<std::string> links(const nlohmann::json& document, std::string_view relation) {
    std::vector<std::string> urls;
    for (const auto& link : document["links"])
      if (link["rel"] == relation) urls.push_back(link["href"]);
    return urls;
  }

  /// A job of export-for-simulation.
  std::string submit(std::string body = kBox) {
    const auto response = send("POST", kExecution, std::move(body));
    EXPECT_EQ(response.status, 201) << text(response);
    return document(response)["jobID"];
  }
  /// The job that `body` asks for, successful.
  std::string finished(std::string body) {
    auto id = submit(std::move(body));
    service_.succeed(service_.start(), JobService::export_files());
    return id;
  }

  JobService service_;
  Api api_{service_.jobs(), service_.metrics(), {}};
};

}  // namespace citymesh
