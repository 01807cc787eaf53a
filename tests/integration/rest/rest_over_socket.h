#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "services/rest/server.h"
#include "tests/integration/rest/connection.h"
#include "tests/unit/rest/job_service.h"

namespace citymesh {

inline constexpr auto* kBox = R"({"inputs":{"bbox":{"bbox":[13.4,52.5,13.41,52.51]}}})";

inline constexpr auto* kAsync = "Prefer: respond-async\r\n";

/// `fields` are header lines, each with its end.
inline std::string request(std::string_view method, std::string_view target,
                           std::string_view body = {}, std::string_view fields = {}) {
  std::string text = fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\n{}", method, target, fields);
  if (!body.empty())
    text += fmt::format("Content-Type: application/json\r\nContent-Length: {}\r\n", body.size());
  return text + "\r\n" + std::string(body);
}

class RestOverSocket : public ::testing::Test {
 protected:
  void start(RestOptions options = {}) {
    options.port = 0;
    server_ = std::make_unique<RestServer>(service_.jobs(), service_.metrics(), options);
    port_ = must(server_->start());
  }

  Connection::Answer send(std::string_view bytes) {
    Connection connection(port_);
    connection.send(bytes);
    auto answer = connection.read();
    if (!answer) {
      ADD_FAILURE() << "no answer";
      return {};
    }
    return *answer;
  }
  void expect_still_working() { EXPECT_EQ(send(request("GET", "/processes")).status, 200); }

  std::string finished_job(const std::vector<JobService::File>& files) {
    const auto status = send(request("POST", "/processes/export-for-simulation/execution", kBox));
    service_.succeed(service_.start(), files);
    return nlohmann::json::parse(status.body)["jobID"];
  }

  JobService service_;
  std::unique_ptr<RestServer> server_;
  std::uint16_t port_ = 0;
};

}  // namespace citymesh
