#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "services/callbacks/address_guard.h"
#include "services/jobs/job_manager.h"
#include "services/rest/server.h"
#include "services/stores/embedded_store.h"
#include "services/stores/folder_results.h"
#include "services/telemetry/log.h"
#include "services/telemetry/metrics.h"
#include "services/worker/worker.h"
#include "tests/integration/rest/connection.h"
#include "tests/support/temp_folder.h"

namespace citymesh {

inline constexpr auto* kEchoExecution = "/processes/echo/execution";
inline constexpr auto* kOgc = "http://www.opengis.net/def/rel/ogc/1.0/";
inline constexpr auto* kConformance = "http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/";
inline constexpr auto* kExceptionTypes =
    "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/";

/// The whole service, stores and workers included, as a client meets it.
class LiveService : public ::testing::Test {
 protected:
  using json = nlohmann::json;
  using Answer = Connection::Answer;

  LiveService() {
    server_ = std::make_unique<RestServer>(jobs_, metrics_, RestOptions{.port = 0});
    const auto port = server_->start();
    EXPECT_TRUE(port);
    port_ = port ? *port : std::uint16_t{0};
    workers_.start();
  }

  Answer send(std::string_view method, std::string_view target, std::string_view body = {},
              std::string_view accept = "application/json", std::string_view fields = {}) {
    Connection connection(port_);
    std::string text = fmt::format("{} {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}", method,
                                   path_of(target), port_, fields);
    if (!accept.empty()) text += fmt::format("Accept: {}\r\n", accept);
    if (!body.empty())
      text += fmt::format("Content-Type: application/json\r\nContent-Length: {}\r\n", body.size());
    connection.send(text + "\r\n" + std::string(body));
    auto answer = connection.read();
    EXPECT_TRUE(answer) << method << ' ' << target;
    return answer.value_or(Answer{});
  }
  Answer get(std::string_view target, std::string_view accept = "application/json") {
    return send("GET", target, {}, accept);
  }
  Answer execute(const json& request, std::string_view prefer = {}) {
    return send("POST", kEchoExecution, request.dump(), "application/json",
                prefer.empty() ? std::string() : fmt::format("Prefer: {}\r\n", prefer));
  }
  /// A document that must be there.
  json document(std::string_view target) {
    const auto answer = get(target);
    EXPECT_EQ(answer.status, 200) << target << ": " << answer.body;
    EXPECT_TRUE(answer.headers.at("content-type").starts_with("application/json") ||
                answer.headers.at("content-type").starts_with("application/vnd.oai.openapi+json"))
        << target;
    return json::parse(answer.body);
  }

  /// Follows the links of the status, as the official suite does, until there are results.
  json ended(const std::string& job) {
    for (;;) {
      auto status = document(job);
      const auto state = status["status"].get<std::string>();
      if (state != "accepted" && state != "running") return status;
      EXPECT_TRUE(link(status, "monitor"));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  static std::optional<std::string> link(const json& document, std::string_view relation) {
    for (const auto& link : document.at("links"))
      if (link.at("rel") == relation) return link.at("href").get<std::string>();
    return std::nullopt;
  }

  // What the schemas of the standard ask for.

  static void expect_links(const json& document) {
    ASSERT_TRUE(document.contains("links"));
    for (const auto& link : document["links"]) {
      ASSERT_TRUE(link.contains("href")) << link;
      EXPECT_TRUE(link["href"].get<std::string>().starts_with("http://127.0.0.1:")) << link;
      for (const auto* text : {"rel", "type", "title", "hreflang"})
        if (link.contains(text)) {
          EXPECT_TRUE(link[text].is_string()) << link;
        }
    }
  }
  static void expect_status_info(const json& status) {
    EXPECT_TRUE(status.at("jobID").is_string());
    EXPECT_EQ(status.at("type"), "process");
    EXPECT_TRUE(status.at("processID").is_string());
    const auto states = json({"accepted", "running", "successful", "failed", "dismissed"});
    EXPECT_NE(std::find(states.begin(), states.end(), status.at("status")), states.end());
    if (status.contains("progress")) {
      EXPECT_GE(status["progress"], 0);
      EXPECT_LE(status["progress"], 100);
    }
    for (const auto* time : {"created", "started", "finished", "updated"})
      if (status.contains(time)) {
        EXPECT_TRUE(status[time].is_string()) << time;
      }
    expect_links(status);
  }
  static void expect_exception(const Answer& answer, int status, std::string_view type) {
    EXPECT_EQ(answer.status, status) << answer.body;
    const auto problem = json::parse(answer.body);
    EXPECT_EQ(problem.at("type"), type.empty() ? std::string("about:blank")
                                               : fmt::format("{}{}", kExceptionTypes, type));
    for (const auto* text : {"title", "detail", "instance"})
      if (problem.contains(text)) {
        EXPECT_TRUE(problem[text].is_string());
      }
    EXPECT_EQ(problem.at("status"), status);
  }
  static std::string path_of(std::string_view url) {
    if (!url.starts_with("http://")) return std::string(url);
    return std::string(url.substr(std::min(url.find('/', 7), url.size())));
  }

  TempFolder folder_;
  std::unique_ptr<EmbeddedStore> store_ = *EmbeddedStore::open(folder_ / "jobs.sqlite");
  std::unique_ptr<FolderResultStore> results_ = *FolderResultStore::open(folder_ / "results");
  std::ostringstream lines_;
  Log log_{lines_};
  Metrics metrics_;
  JobManager jobs_{*store_,
                   *store_,
                   *results_,
                   {.max_open_jobs = 100, .check_callback = [](const std::string& uri) {
                      return check_callback_uri(uri, true);  // the tests listen on loopback
                    }}};
  WorkerPool workers_{
      *store_,       *store_,
      *results_,     [] { return fail(ErrorCode::NotFound, "this service has no cities"); },
      log_,          metrics_,
      {.workers = 4}};
  std::unique_ptr<RestServer> server_;
  std::uint16_t port_ = 0;
};

}  // namespace citymesh
