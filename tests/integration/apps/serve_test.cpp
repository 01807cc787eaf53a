#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "citymesh/v1/jobs.grpc.pb.h"
#include "tests/integration/apps/big_city.h"
#include "tests/integration/apps/program.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// `citymesh serve` as a child process with a gRPC client.
class Server {
 public:
  Server(const std::filesystem::path& data, const std::filesystem::path& state,
         std::vector<std::string> more = {})
      : program_(arguments(data, state, std::move(more))) {
    while (program_.runs() && !find("listening"))
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const auto listening = find("listening");
    if (!listening) throw std::runtime_error("the server did not start: " + program_.err());
    stub_ = v1::Jobs::NewStub(grpc::CreateChannel(listening->at("grpc").get<std::string>(),
                                                  grpc::InsecureChannelCredentials()));
  }

  /// The first log line of an event.
  std::optional<json> find(const std::string& event) const {
    std::istringstream lines(program_.out());
    for (std::string line; std::getline(lines, line);) {
      auto parsed = json::parse(line, nullptr, false);
      if (parsed.is_object() && parsed.value("event", "") == event) return parsed;
    }
    return std::nullopt;
  }

  std::string submit() {
    v1::SubmitRequest request;
    request.set_process("export-for-simulation");
    request.set_inputs_json("{}");
    grpc::ClientContext context;
    v1::Job job;
    const auto status = stub_->Submit(&context, request, &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job.job_id();
  }

  v1::Job get(const std::string& id) {
    grpc::ClientContext context;
    v1::Job job;
    const auto status = stub_->Get(&context, request(id), &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }

  /// Until the job runs and has shown progress, or is final.
  v1::Job at_work(const std::string& id) {
    return watch(id, [](const v1::Job& job) { return job.done() > 0; });
  }
  v1::Job ended(const std::string& id) {
    return watch(id, [](const v1::Job&) { return false; });
  }

  v1::Job dismiss(const std::string& id) {
    grpc::ClientContext context;
    v1::Job job;
    EXPECT_TRUE(stub_->Dismiss(&context, request(id), &job).ok());
    return job;
  }

  Program& program() { return program_; }

 private:
  static std::vector<std::string> arguments(const std::filesystem::path& data,
                                            const std::filesystem::path& state,
                                            std::vector<std::string> more) {
    std::vector<std::string> all{"serve",       "--data",       data.string(),
                                 "--state",     state.string(), "--listen",
                                 "127.0.0.1:0", "--grpc",       "127.0.0.1:0"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  static v1::GetRequest request(const std::string& id) {
    v1::GetRequest request;
    request.set_job_id(id);
    return request;
  }

  template <class Enough>
  v1::Job watch(const std::string& id, const Enough& enough) {
    grpc::ClientContext context;
    const auto reader = stub_->Watch(&context, request(id));
    v1::Job job;
    while (reader->Read(&job))
      if (enough(job)) break;
    context.TryCancel();
    return job;
  }

  Program program_;
  std::unique_ptr<v1::Jobs::Stub> stub_;
};

class ServeTest : public testing::Test {
 protected:
  ServeTest() { make_big_city(folder_ / "city", 10); }

  TempFolder folder_;
};

TEST_F(ServeTest, AJobSurvivesTheSuddenDeathOfTheServer) {
  std::string id;
  {
    Server server(folder_ / "city", folder_ / "state");
    id = server.submit();
    EXPECT_EQ(server.at_work(id).state(), v1::RUNNING);
    server.program().send(SIGKILL);
    EXPECT_EQ(server.program().wait(), 128 + SIGKILL);
  }
  Server server(folder_ / "city", folder_ / "state");
  const auto job = server.ended(id);
  EXPECT_EQ(job.state(), v1::SUCCESSFUL) << job.message();
  EXPECT_GT(job.results_size(), 0);
  EXPECT_TRUE(server.find("jobs_recovered"));
}

TEST_F(ServeTest, AJobThatKillsItsServerIsFailedAfterTheLastTry) {
  std::string id;
  for (int death = 0; death < 2; ++death) {
    Server server(folder_ / "city", folder_ / "state", {"--max_attempts", "2"});
    if (id.empty()) id = server.submit();
    EXPECT_EQ(server.at_work(id).state(), v1::RUNNING);
    server.program().send(SIGKILL);
    EXPECT_EQ(server.program().wait(), 128 + SIGKILL);
  }
  Server server(folder_ / "city", folder_ / "state", {"--max_attempts", "2"});
  const auto job = server.ended(id);
  EXPECT_EQ(job.state(), v1::FAILED);
  EXPECT_THAT(job.message(), HasSubstr("the worker died 2 times"));
  // The files go once the job has ended, not before.
  const auto half_a_result = folder_ / "state" / "results" / id;
  for (int i = 0; i < 500 && std::filesystem::exists(half_a_result); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(std::filesystem::exists(half_a_result));
}

TEST_F(ServeTest, AGracefulStopHandsTheJobToTheNextServer) {
  std::string id;
  {
    Server server(folder_ / "city", folder_ / "state", {"--max_attempts", "1"});
    id = server.submit();
    EXPECT_EQ(server.at_work(id).state(), v1::RUNNING);
    server.program().send(SIGTERM);
    EXPECT_EQ(server.program().wait(), 0) << server.program().err();
    EXPECT_TRUE(server.find("stopped"));
  }
  Server server(folder_ / "city", folder_ / "state", {"--max_attempts", "1"});
  EXPECT_EQ(server.ended(id).state(), v1::SUCCESSFUL);
}

TEST_F(ServeTest, ADismissedJobStopsAndTheNextOneRuns) {
  Server server(folder_ / "city", folder_ / "state");
  const auto first = server.submit();
  server.at_work(first);
  EXPECT_EQ(server.dismiss(first).state(), v1::DISMISSED);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "state" / "results" / first));
  EXPECT_EQ(server.ended(server.submit()).state(), v1::SUCCESSFUL);
}

TEST_F(ServeTest, ADamagedJobDatabaseIsNamedAndNothingIsServed) {
  std::filesystem::create_directories(folder_ / "state");
  std::ofstream(folder_ / "state" / "jobs.sqlite") << std::string(5000, 'x');
  Program program({"serve", "--data", (folder_ / "city").string(), "--state",
                   (folder_ / "state").string(), "--listen", "127.0.0.1:0", "--grpc",
                   "127.0.0.1:0"});
  EXPECT_EQ(program.wait(), 2);
  EXPECT_THAT(program.err(), HasSubstr("jobs.sqlite"));
}

}  // namespace
}  // namespace citymesh
