#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "citymesh/v1/error_details.pb.h"
#include "citymesh/v1/jobs.grpc.pb.h"
#include "services/jobs/job_manager.h"
#include "services/jobs/retention.h"
#include "services/offer/offer.h"
#include "services/rpc/server.h"
#include "services/stores/embedded_store.h"
#include "services/stores/folder_results.h"
#include "services/telemetry/metrics.h"
#include "tests/support/temp_folder.h"

namespace citymesh {
namespace {

using testing::HasSubstr;

constexpr TimeMs kLongLease = 60'000;

/// The real server on a loopback port over real stores. No worker: a test moves its jobs itself.
class RpcServerTest : public testing::Test {
 protected:
  RpcServerTest()
      : store_(*EmbeddedStore::open(folder_ / "jobs.sqlite")),
        results_(*FolderResultStore::open(folder_ / "results")),
        jobs_(*store_, *store_, *results_,
              {.max_open_jobs = 10,
               .estimate =
                   [](const std::string& process, const std::string&) {
                     Estimate expected{.process = process, .buildings = 12, .triangles = 480};
                     expected.outputs = {{"obj", 16'800}};
                     expected.problems = {"a.gml cannot be read"};
                     return Result<Estimate>(expected);
                   },
               .check_callback = [](const std::string&) { return Result<void>{}; },
               .dismiss_wait_ms = 50}),
        server_(jobs_, metrics_,
                {.port = 0,
                 .max_message_bytes = 64 << 10,
                 .max_watches = 2,
                 .links_base = "https://citymesh.test"}) {
    const auto port = server_.start();
    EXPECT_TRUE(port) << port.error().message;
    channel_ = grpc::CreateChannel("127.0.0.1:" + std::to_string(port ? *port : 0),
                                   grpc::InsecureChannelCredentials());
    stub_ = v1::Jobs::NewStub(channel_);
  }

  std::pair<grpc::Status, v1::Job> submit(const std::string& process, const std::string& inputs) {
    v1::SubmitRequest request;
    request.set_process(process);
    request.set_inputs_json(inputs);
    grpc::ClientContext context;
    v1::Job job;
    auto status = stub_->Submit(&context, request, &job);
    return {status, job};
  }

  std::string submitted() {
    const auto [status, job] = submit("export-for-simulation", "{}");
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job.job_id();
  }

  v1::GetRequest id_of(const std::string& id) {
    v1::GetRequest request;
    request.set_job_id(id);
    return request;
  }

  Claim started() {
    const auto claim = store_->claim("worker", kLongLease, 0);
    EXPECT_TRUE(claim && *claim);
    EXPECT_TRUE(store_->update((*claim)->job_id, (*claim)->attempt,
                               [](Job& job) { job.state = JobState::Running; }));
    return **claim;
  }

  void succeed(const Claim& claim, const std::string& mesh) {
    const auto folder = results_->stage(claim.job_id, claim.attempt);
    ASSERT_TRUE(folder);
    std::ofstream(*folder / "model.obj", std::ios::binary) << mesh;
    ASSERT_TRUE(results_->commit(claim.job_id, claim.attempt));
    ASSERT_TRUE(store_->update(claim.job_id, claim.attempt, [&](Job& job) {
      job.state = JobState::Successful;
      job.finished = now_ms();
      job.results = {{"obj", "model.obj", "model/obj", mesh.size()}};
    }));
    ASSERT_TRUE(store_->done(claim));
  }

  std::pair<grpc::Status, std::string> fetch(const std::string& id, const std::string& output,
                                             std::uint64_t offset = 0) {
    v1::FetchResultRequest request;
    request.set_job_id(id);
    request.set_output(output);
    request.set_offset(offset);
    grpc::ClientContext context;
    const auto reader = stub_->FetchResult(&context, request);
    std::string bytes;
    v1::Chunk chunk;
    while (reader->Read(&chunk)) {
      EXPECT_LE(chunk.data().size(), 256u * 1024);
      bytes += chunk.data();
    }
    return {reader->Finish(), bytes};
  }

  TempFolder folder_;
  std::unique_ptr<EmbeddedStore> store_;
  std::unique_ptr<FolderResultStore> results_;
  Metrics metrics_;
  JobManager jobs_;
  RpcServer server_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::Jobs::Stub> stub_;
};

TEST_F(RpcServerTest, ASubmittedJobCanBeAskedFor) {
  const auto id = submitted();
  grpc::ClientContext context;
  v1::Job job;
  const auto status = stub_->Get(&context, id_of(id), &job);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(job.job_id(), id);
  EXPECT_EQ(job.state(), v1::ACCEPTED);
  EXPECT_EQ(job.process(), "export-for-simulation");
  EXPECT_GT(job.created_ms(), 0);
}

TEST_F(RpcServerTest, HealIsTakenWithItsLimits) {
  const auto [status, job] = submit("heal", R"({"max_hole_area_m2":25,"formats":["citygml3"]})");
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(job.process(), "heal");
  EXPECT_TRUE(submit("heal", R"({"parts":"merge"})").first.ok());
  EXPECT_EQ(submit("heal", R"({"parts":"split"})").first.error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(submit("heal", R"({"max_hole_area_m2":-1})").first.error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(RpcServerTest, AnEstimateMakesNoJob) {
  v1::SubmitRequest request;
  request.set_process("export-for-simulation");
  grpc::ClientContext context;
  v1::EstimateReply expected;
  const auto status = stub_->Estimate(&context, request, &expected);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(expected.buildings(), 12u);
  EXPECT_EQ(expected.expected_triangles(), 480u);
  ASSERT_EQ(expected.outputs_size(), 1);
  EXPECT_EQ(expected.outputs(0).output(), "obj");
  EXPECT_EQ(expected.outputs(0).bytes(), 16'800u);
  EXPECT_EQ(expected.problems(0), "a.gml cannot be read");
  EXPECT_EQ(*jobs_.count({}), 0u);
}

TEST_F(RpcServerTest, ARepeatedRequestWithItsKeyGetsTheSameJob) {
  const auto keyed = [this](const std::string& key, const std::string& inputs) {
    v1::SubmitRequest request;
    request.set_process("validate");
    request.set_inputs_json(inputs);
    request.set_idempotency_key(key);
    grpc::ClientContext context;
    v1::Job job;
    auto status = stub_->Submit(&context, request, &job);
    return std::pair(status, job.job_id());
  };
  const auto first = keyed("a-key", "{}");
  ASSERT_TRUE(first.first.ok()) << first.first.error_message();
  EXPECT_EQ(keyed("a-key", "{}").second, first.second);
  EXPECT_NE(keyed("another", "{}").second, first.second);
  EXPECT_EQ(keyed("a-key", R"({"lod":["1"]})").first.error_code(),
            grpc::StatusCode::ALREADY_EXISTS);
  EXPECT_EQ(keyed("a\nkey", "{}").first.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(RpcServerTest, ASubscriberIsKeptWithTheAddressOfTheLinks) {
  v1::SubmitRequest request;
  request.set_process("validate");
  request.mutable_subscriber()->set_success_uri("https://client.test/done");
  grpc::ClientContext context;
  v1::Job job;
  ASSERT_TRUE(stub_->Submit(&context, request, &job).ok());
  const auto kept = jobs_.get(job.job_id());
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->spec.subscriber.success_uri, "https://client.test/done");
  EXPECT_EQ(kept->spec.subscriber.base, "https://citymesh.test");
}

TEST_F(RpcServerTest, ErrorsSayTheirReasonAndWhenToTryAgain) {
  const auto details = [](const grpc::Status& status) {
    v1::Status said;
    EXPECT_TRUE(said.ParseFromString(status.error_details()));
    EXPECT_EQ(said.code(), status.error_code());
    EXPECT_EQ(said.message(), status.error_message());
    v1::ErrorInfo info;
    EXPECT_EQ(said.details(0).type_url(), "type.googleapis.com/google.rpc.ErrorInfo");
    EXPECT_TRUE(info.ParseFromString(said.details(0).value()));
    EXPECT_EQ(info.domain(), "citymesh");
    return std::pair(info.reason(), said);
  };
  const auto [reason, unknown] = details(submit("fly", "{}").first);
  EXPECT_EQ(reason, to_string(ErrorCode::NotFound));
  EXPECT_EQ(unknown.details_size(), 1);
  for (int i = 0; i < 10; ++i) submitted();
  const auto [full, again] = details(submit("validate", "{}").first);
  EXPECT_EQ(full, to_string(ErrorCode::ResourceExhausted));
  ASSERT_EQ(again.details_size(), 2);
  v1::RetryInfo retry;
  EXPECT_EQ(again.details(1).type_url(), "type.googleapis.com/google.rpc.RetryInfo");
  EXPECT_TRUE(retry.ParseFromString(again.details(1).value()));
  EXPECT_GT(retry.retry_delay().seconds(), 0);
}

TEST_F(RpcServerTest, ErrorsKeepTheirCodeAndMessage) {
  const auto unknown = submit("fly", "{}").first;
  EXPECT_EQ(unknown.error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_THAT(unknown.error_message(), HasSubstr("export-for-simulation"));
  EXPECT_EQ(submit("export-for-simulation", "{\"lod\":").first.error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  grpc::ClientContext context;
  v1::Job job;
  EXPECT_EQ(stub_->Get(&context, id_of("none"), &job).error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(fetch(submitted(), "obj").first.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  for (int i = 1; i < 10; ++i) submitted();
  EXPECT_EQ(submit("export-for-simulation", "{}").first.error_code(),
            grpc::StatusCode::RESOURCE_EXHAUSTED);
}

TEST_F(RpcServerTest, AnOversizeMessageIsRefusedAndTheNextCallWorks) {
  const auto status = submit("export-for-simulation", std::string(1 << 20, ' ')).first;
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  submitted();
}

TEST_F(RpcServerTest, WatchGivesThePresentStateEveryChangeAndEndsWithTheFinalState) {
  const auto id = submitted();
  grpc::ClientContext context;
  const auto reader = stub_->Watch(&context, id_of(id));
  v1::Job job;
  ASSERT_TRUE(reader->Read(&job));
  EXPECT_EQ(job.state(), v1::ACCEPTED);

  const auto claim = started();
  ASSERT_TRUE(store_->set_progress(id, claim.attempt, {"heal", 1, 2}, "heal: 1 of 2", 50));
  while (job.percent() != 50) ASSERT_TRUE(reader->Read(&job));
  EXPECT_EQ(job.stage(), "heal");
  EXPECT_EQ(job.done(), 1u);
  succeed(claim, "v 0 0 0");
  while (job.state() != v1::SUCCESSFUL) ASSERT_TRUE(reader->Read(&job));
  EXPECT_EQ(job.results(0).file_name(), "model.obj");
  EXPECT_FALSE(reader->Read(&job));
  EXPECT_TRUE(reader->Finish().ok());
}

TEST_F(RpcServerTest, AClientThatLeavesFreesItsWatch) {
  const auto id = submitted();
  for (int i = 0; i < 10; ++i) {  // the limit is two at the same time
    grpc::Status status;
    do {
      grpc::ClientContext context;
      const auto reader = stub_->Watch(&context, id_of(id));
      v1::Job job;
      const auto read = reader->Read(&job);
      context.TryCancel();
      status = reader->Finish();
      if (read) {
        EXPECT_EQ(status.error_code(), grpc::StatusCode::CANCELLED);
      }
    } while (status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED);
  }
}

TEST_F(RpcServerTest, MoreWatchesThanTheLimitAreRefused) {
  const auto id = submitted();
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::Job>>> readers;
  v1::Job job;
  for (int i = 0; i < 2; ++i) {
    contexts.push_back(std::make_unique<grpc::ClientContext>());
    readers.push_back(stub_->Watch(contexts.back().get(), id_of(id)));
    ASSERT_TRUE(readers.back()->Read(&job));
  }
  grpc::ClientContext context;
  const auto refused = stub_->Watch(&context, id_of(id));
  EXPECT_FALSE(refused->Read(&job));
  EXPECT_EQ(refused->Finish().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  server_.stop();  // ends the open ones
  for (auto& reader : readers) {
    while (reader->Read(&job)) {
    }
    EXPECT_FALSE(reader->Finish().ok());
  }
}

TEST_F(RpcServerTest, DismissEndsAQueuedJob) {
  const auto id = submitted();
  grpc::ClientContext context;
  v1::Job job;
  ASSERT_TRUE(stub_->Dismiss(&context, id_of(id), &job).ok());
  EXPECT_EQ(job.state(), v1::DISMISSED);
}

TEST_F(RpcServerTest, ResultsComeInChunksByOutputOrFileName) {
  const auto id = submitted();
  std::string mesh;
  for (int i = 0; mesh.size() < 700'000; ++i) mesh += "v " + std::to_string(i) + " 0 0\n";
  succeed(started(), mesh);
  for (const auto* name : {"obj", "model.obj"}) {
    const auto [status, bytes] = fetch(id, name);
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_TRUE(bytes == mesh) << name;
  }
  for (const auto* name : {"", "../model.obj", "report.json"}) {
    const auto status = fetch(id, name).first;
    EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND) << name;
    EXPECT_THAT(status.error_message(), HasSubstr("model.obj"));
  }
}

TEST_F(RpcServerTest, ResultsThatHaveExpiredAreNotFoundAndNotListed) {
  const auto id = submitted();
  succeed(started(), "v 0 0 0\n");
  ASSERT_TRUE(sweep(*store_, *results_, {.keep_results_ms = 1}, now_ms() + 1'000));
  const auto [status, bytes] = fetch(id, "obj");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_THAT(status.error_message(), HasSubstr("job " + id + ": its results have expired"));
  EXPECT_EQ(bytes, "");

  grpc::ClientContext context;
  v1::Job job;
  ASSERT_TRUE(stub_->Get(&context, id_of(id), &job).ok());
  EXPECT_EQ(job.state(), v1::SUCCESSFUL);
  EXPECT_EQ(job.message(), "results have expired");
  EXPECT_EQ(job.results_size(), 0);
}

TEST_F(RpcServerTest, AJobTellsWhetherItsResultsAreThoseOfAnEarlierOne) {
  for (const bool cached : {false, true}) {
    const auto id = submitted();
    const auto claim = started();
    ASSERT_TRUE(
        store_->update(id, claim.attempt, [cached](Job& changed) { changed.cached = cached; }));
    succeed(claim, "v 0 0 0");
    grpc::ClientContext context;
    v1::Job job;
    ASSERT_TRUE(stub_->Get(&context, id_of(id), &job).ok());
    EXPECT_EQ(job.cached(), cached);
  }
}

TEST_F(RpcServerTest, CallsAreCounted) {
  submitted();
  EXPECT_THAT(metrics_.text(),
              HasSubstr("citymesh_grpc_requests_total{code=\"OK\",method=\"Submit\"} 1"));
}

TEST_F(RpcServerTest, ATakenPortIsAnError) {
  RpcServer first(jobs_, metrics_, {.port = 0});
  const auto port = first.start();
  ASSERT_TRUE(port);
  RpcServer second(jobs_, metrics_, {.port = *port});
  const auto taken = second.start();
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(taken.error().message, HasSubstr(std::to_string(*port)));
}

TEST_F(RpcServerTest, ADownloadIsResumedWhereItBroke) {
  const auto id = submitted();
  std::string mesh(300'000, 'v');
  mesh += "the end";
  succeed(started(), mesh);
  EXPECT_EQ(fetch(id, "obj").second, mesh);
  EXPECT_EQ(fetch(id, "obj", 299'999).second, "vthe end");
  const auto [done, nothing] = fetch(id, "obj", mesh.size());
  EXPECT_TRUE(done.ok());
  EXPECT_EQ(nothing, "");
  const auto beyond = fetch(id, "obj", mesh.size() + 1).first;
  EXPECT_EQ(beyond.error_code(), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_THAT(beyond.error_message(), HasSubstr("offset is 300008, expected at most 300007"));
}

TEST_F(RpcServerTest, JobsAreListedNewestFirstByStateAndProcess) {
  const auto list = [&](const v1::ListRequest& request) {
    grpc::ClientContext context;
    v1::ListReply reply;
    const auto status = stub_->List(&context, request, &reply);
    return std::pair(status, reply);
  };
  const auto first = submitted(), second = submitted();
  const auto heal = submit("heal", "{}").second.job_id();
  succeed(started(), "v");

  const auto [status, all] = list({});
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(all.matched(), 3u);
  ASSERT_EQ(all.jobs_size(), 3);
  EXPECT_EQ(all.jobs(0).job_id(), heal);

  v1::ListRequest of_exports;
  of_exports.add_processes("export-for-simulation");
  of_exports.add_states(v1::SUCCESSFUL);
  const auto exports = list(of_exports).second;
  ASSERT_EQ(exports.jobs_size(), 1);
  EXPECT_EQ(exports.jobs(0).job_id(), first);

  v1::ListRequest page;
  page.set_limit(1);
  page.set_offset(1);
  const auto middle = list(page).second;
  EXPECT_EQ(middle.matched(), 3u);
  ASSERT_EQ(middle.jobs_size(), 1);
  EXPECT_EQ(middle.jobs(0).job_id(), second);

  page.set_limit(1001);
  const auto refused = list(page).first;
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(refused.error_message(), HasSubstr("limit is 1001, expected 1 to 1000"));
  v1::ListRequest odd;
  odd.add_states(static_cast<v1::JobState>(9));
  EXPECT_THAT(list(odd).first.error_message(), HasSubstr("states has 9"));
}

TEST_F(RpcServerTest, ProcessesAreDescribedAsTheTableHasThem) {
  grpc::ClientContext context;
  v1::ProcessesReply reply;
  ASSERT_TRUE(stub_->Processes(&context, {}, &reply).ok());
  ASSERT_EQ(reply.processes_size(), static_cast<int>(offered_processes().size()));
  for (int i = 0; i < reply.processes_size(); ++i) {
    const auto& told = reply.processes(i);
    const auto& meant = offered_processes()[static_cast<std::size_t>(i)];
    EXPECT_EQ(told.id(), meant.id);
    ASSERT_EQ(told.inputs_size(), static_cast<int>(meant.inputs.size()));
    for (int k = 0; k < told.inputs_size(); ++k) {
      const auto& input = told.inputs(k);
      const auto& option = meant.inputs[static_cast<std::size_t>(k)];
      EXPECT_EQ(input.name(), option.name);
      EXPECT_EQ(input.default_json(), option.default_json);
      EXPECT_EQ(input.choices_size(), static_cast<int>(option.choices.size()));
      EXPECT_EQ(input.has_minimum(), option.minimum < option.maximum);
    }
    EXPECT_EQ(told.outputs_size(), static_cast<int>(meant.outputs.size()));
  }
}

}  // namespace
}  // namespace citymesh
