#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <fstream>

#include "citymesh/v1/jobs.grpc.pb.h"
#include "services/access/access.h"
#include "services/access/api_keys.h"
#include "services/jobs/job_manager.h"
#include "services/rpc/caller.h"
#include "services/rpc/server.h"
#include "services/stores/embedded_store.h"
#include "services/stores/folder_results.h"
#include "services/telemetry/metrics.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/access/certificate.h"

namespace citymesh {
namespace {

using grpc::StatusCode;
using testing::HasSubstr;

class RpcAccessTest : public testing::Test {
 protected:
  RpcAccessTest() {
    std::ofstream keys(folder_ / "keys");
    for (const auto* key : {&city_, &reader_, &port_, &writer_, &operator_})
      keys << key->line << '\n';
    keys.close();
    access_ = *Access::open({.api_keys = folder_ / "keys"});
    server_.emplace(jobs_, metrics_, RpcOptions{.port = 0, .access = access_.get()});
    const auto port = server_->start();
    EXPECT_TRUE(port) << port.error().message;
    stub_ = v1::Jobs::NewStub(grpc::CreateChannel("127.0.0.1:" + std::to_string(port ? *port : 0),
                                                  grpc::InsecureChannelCredentials()));
  }

  static void show(grpc::ClientContext& context, const NewApiKey* key) {
    if (key != nullptr) context.AddMetadata("authorization", "Bearer " + key->key);
  }
  std::pair<StatusCode, v1::Job> submit(const NewApiKey* key, const std::string& inputs = "{}") {
    grpc::ClientContext context;
    show(context, key);
    v1::SubmitRequest request;
    request.set_process("export-for-simulation");
    request.set_inputs_json(inputs);
    v1::Job job;
    const auto status = stub_->Submit(&context, request, &job);
    return {status.error_code(), job};
  }
  StatusCode get(const NewApiKey* key, const std::string& id) {
    grpc::ClientContext context;
    show(context, key);
    v1::Job job;
    return stub_->Get(&context, request(id), &job).error_code();
  }
  StatusCode dismiss(const NewApiKey* key, const std::string& id) {
    grpc::ClientContext context;
    show(context, key);
    v1::Job job;
    return stub_->Dismiss(&context, request(id), &job).error_code();
  }
  StatusCode watch(const NewApiKey* key, const std::string& id) {
    grpc::ClientContext context;
    show(context, key);
    const auto reader = stub_->Watch(&context, request(id));
    v1::Job job;
    if (reader->Read(&job)) context.TryCancel();
    return reader->Finish().error_code();
  }
  StatusCode fetch(const NewApiKey* key, const std::string& id) {
    grpc::ClientContext context;
    show(context, key);
    v1::FetchResultRequest request;
    request.set_job_id(id);
    request.set_output("obj");
    const auto reader = stub_->FetchResult(&context, request);
    v1::Chunk chunk;
    while (reader->Read(&chunk)) continue;
    return reader->Finish().error_code();
  }
  std::pair<StatusCode, std::uint64_t> list(const NewApiKey* key) {
    grpc::ClientContext context;
    show(context, key);
    v1::ListReply reply;
    const auto status = stub_->List(&context, {}, &reply);
    EXPECT_EQ(reply.matched(), static_cast<std::uint64_t>(reply.jobs_size()));
    return {status.error_code(), reply.matched()};
  }
  static v1::GetRequest request(const std::string& id) {
    v1::GetRequest request;
    request.set_job_id(id);
    return request;
  }

  TempFolder folder_;
  NewApiKey city_ = *make_api_key("city", Role::Submit);
  NewApiKey reader_ = *make_api_key("city", Role::ReadOwn);
  NewApiKey port_ = *make_api_key("port", Role::Submit);
  NewApiKey writer_ = *make_api_key("writer", Role::WriteBack);
  NewApiKey operator_ = *make_api_key("operator", Role::Admin);
  std::unique_ptr<EmbeddedStore> store_ = *EmbeddedStore::open(folder_ / "jobs.sqlite");
  std::unique_ptr<FolderResultStore> results_ = *FolderResultStore::open(folder_ / "results");
  Metrics metrics_;
  JobManager jobs_{*store_, *store_, *results_, {.dismiss_wait_ms = 50}};
  std::unique_ptr<Access> access_;
  std::optional<RpcServer> server_;
  std::unique_ptr<v1::Jobs::Stub> stub_;
};

TEST_F(RpcAccessTest, OnlyTheProcessesAreForEverybody) {
  grpc::ClientContext context;
  v1::ProcessesReply processes;
  EXPECT_TRUE(stub_->Processes(&context, {}, &processes).ok());

  const auto id = submit(&city_).second.job_id();
  const auto stranger = *make_api_key("city", Role::Admin);
  for (const auto* key : {static_cast<const NewApiKey*>(nullptr), &stranger}) {
    EXPECT_EQ(submit(key).first, StatusCode::UNAUTHENTICATED);
    EXPECT_EQ(get(key, id), StatusCode::UNAUTHENTICATED);
    EXPECT_EQ(watch(key, id), StatusCode::UNAUTHENTICATED);
    EXPECT_EQ(fetch(key, id), StatusCode::UNAUTHENTICATED);
    EXPECT_EQ(dismiss(key, id), StatusCode::UNAUTHENTICATED);
    EXPECT_EQ(list(key).first, StatusCode::UNAUTHENTICATED);
  }
  EXPECT_EQ(list(&operator_).second, 1u);
}

TEST_F(RpcAccessTest, TheKeyMayComeUnderItsOwnName) {
  grpc::ClientContext context;
  context.AddMetadata("x-api-key", city_.key);
  v1::ListReply reply;
  EXPECT_TRUE(stub_->List(&context, {}, &reply).ok());
}

TEST_F(RpcAccessTest, AJobOfAnotherClientDoesNotExist) {
  const auto id = submit(&city_).second.job_id();
  EXPECT_EQ(get(&port_, id), StatusCode::NOT_FOUND);
  EXPECT_EQ(watch(&port_, id), StatusCode::NOT_FOUND);
  EXPECT_EQ(fetch(&port_, id), StatusCode::NOT_FOUND);
  EXPECT_EQ(dismiss(&port_, id), StatusCode::NOT_FOUND);
  EXPECT_EQ(list(&port_).second, 0u);
  EXPECT_EQ(get(&city_, id), StatusCode::OK);
  EXPECT_EQ(watch(&city_, id), StatusCode::CANCELLED);
  EXPECT_EQ(fetch(&city_, id), StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(list(&city_).second, 1u);
  EXPECT_EQ(get(&operator_, id), StatusCode::OK);
  EXPECT_EQ(dismiss(&operator_, id), StatusCode::OK);
}

TEST_F(RpcAccessTest, WhoOnlyReadsNeitherSubmitsNorDismisses) {
  const auto id = submit(&city_).second.job_id();
  EXPECT_EQ(submit(&reader_).first, StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(dismiss(&reader_, id), StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(get(&reader_, id), StatusCode::OK);
}

TEST_F(RpcAccessTest, WhoMaySubmitDoesNotWriteBackWithoutThatRole) {
  constexpr const char* kInputs = R"({"write_back": true})";
  EXPECT_EQ(submit(&city_, kInputs).first, StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(list(&operator_).second, 0u);
  EXPECT_EQ(submit(&writer_, kInputs).first, StatusCode::OK);
  EXPECT_EQ(submit(&city_, R"({"write_back": false})").first, StatusCode::OK);
}

TEST(RpcOverTls, IsSpokenWithTheCertificateAndNotWithout) {
  const TempFolder folder;
  const auto certificate = make_certificate();
  write_certificate(folder.path(), certificate);
  const auto store = *EmbeddedStore::open(folder / "jobs.sqlite");
  const auto results = *FolderResultStore::open(folder / "results");
  Metrics metrics;
  JobManager jobs(*store, *store, *results);
  RpcServer server(
      jobs, metrics,
      {.port = 0, .tls_certificate = folder / "certificate.pem", .tls_key = folder / "key.pem"});
  const auto port = server.start();
  ASSERT_TRUE(port) << port.error().message;

  const auto ask = [&](const std::shared_ptr<grpc::ChannelCredentials>& credentials) {
    const auto channel = grpc::CreateChannel("localhost:" + std::to_string(*port), credentials);
    const auto stub = v1::Jobs::NewStub(channel);
    grpc::ClientContext context;
    v1::ProcessesReply processes;
    return stub->Processes(&context, {}, &processes).error_code();
  };
  EXPECT_EQ(ask(grpc::SslCredentials({.pem_root_certs = certificate.certificate_pem})),
            StatusCode::OK);
  EXPECT_EQ(ask(grpc::SslCredentials({.pem_root_certs = make_certificate().certificate_pem})),
            StatusCode::UNAVAILABLE);
  EXPECT_EQ(ask(grpc::InsecureChannelCredentials()), StatusCode::UNAVAILABLE);
}

TEST(RpcOverTls, FilesThatAreNotThereAreNamed) {
  const TempFolder folder;
  const auto store = *EmbeddedStore::open(folder / "jobs.sqlite");
  const auto results = *FolderResultStore::open(folder / "results");
  Metrics metrics;
  JobManager jobs(*store, *store, *results);
  RpcServer server(
      jobs, metrics,
      {.port = 0, .tls_certificate = folder / "certificate.pem", .tls_key = folder / "key.pem"});
  const auto port = server.start();
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().message, HasSubstr("certificate.pem"));
}

TEST(CredentialsTest, ThePeerIsTheAddressUnlessATrustedProxySaysOtherwise) {
  const auto proxies = *Networks::parse("10.0.0.0/8, ::1");
  EXPECT_EQ(credentials_of("ipv4:203.0.113.9:4711", {}, proxies).address, "203.0.113.9");
  EXPECT_EQ(credentials_of("ipv6:%5B2001:db8::9%5D:4711", {}, proxies).address, "2001:db8::9");
  EXPECT_EQ(credentials_of("ipv6:[2001:db8::9]:4711", {}, proxies).address, "2001:db8::9");
  for (const auto* odd : {"", ":", "ipv4", "ipv4:", "ipv6:", "ipv6:[", "unix:/run/x"})
    EXPECT_EQ(
        credentials_of(odd, {{"x-forwarded-for", "192.0.2.1"}}, proxies).address.find("192.0.2.1"),
        std::string::npos);
  EXPECT_EQ(
      credentials_of(
          "ipv6:%5B::1%5D:1",
          {{"x-forwarded-for", "192.0.2.1, 203.0.113.9"}, {"x-forwarded-for", "10.0.0.2"}}, proxies)
          .address,
      "203.0.113.9");
}

}  // namespace
}  // namespace citymesh
