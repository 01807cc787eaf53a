#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <fstream>
#include <memory>
#include <thread>

#include "tests/integration/rest/rest_over_socket.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/access/certificate.h"

namespace citymesh {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class RestOverTls : public RestOverSocket {
 protected:
  using Context = std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)>;

  RestOverTls() { write_certificate(folder_.path(), make_certificate()); }

  TlsFiles files() const { return {folder_ / "certificate.pem", folder_ / "key.pem"}; }

  /// A client that trusts the certificate as it lies there now.
  Context client() const {
    Context context(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
    SSL_CTX_load_verify_file(context.get(), (folder_ / "certificate.pem").c_str());
    SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
    return context;
  }
  /// Status of a request on a connection of its own.
  int status_of(SSL_CTX* context, std::string_view bytes) {
    Connection connection(port_, context);
    if (!connection.greeted()) return -1;
    connection.send(bytes);
    const auto answer = connection.read();
    return answer ? answer->status : 0;
  }

  TempFolder folder_;
};

TEST_F(RestOverTls, JobsAreSubmittedAndFetchedAndLinksAreHttps) {
  start({.tls = files()});
  const auto context = client();
  Connection connection(port_, context.get());
  ASSERT_TRUE(connection.greeted());
  connection.send(request("POST", "/processes/export-for-simulation/execution", kBox));
  const auto created = connection.read();
  ASSERT_TRUE(created);
  EXPECT_EQ(created->status, 201);
  EXPECT_THAT(created->headers.at("location"), testing::StartsWith("https://localhost/jobs/"));

  const auto id = json::parse(created->body)["jobID"].get<std::string>();
  std::string mesh;
  for (int i = 0; mesh.size() < 3'000'000; ++i) mesh += fmt::format("v {} 0 0\n", i);
  service_.succeed(service_.start(), {{"obj", "model.obj", "model/obj", mesh}});
  connection.send(request("GET", "/jobs/" + id + "/results/obj") + request("GET", "/healthz"));
  EXPECT_TRUE(connection.read()->body == mesh);
  EXPECT_EQ(connection.read()->body, "ok\n");
}

TEST_F(RestOverTls, TheConnectionEndsWithAGoodbye) {
  start({.tls = files()});
  const auto context = client();
  Connection connection(port_, context.get());
  connection.send(request("GET", "/healthz", {}, "Connection: close\r\n"));
  EXPECT_EQ(connection.read()->status, 200);
  EXPECT_TRUE(connection.is_closed());
  EXPECT_NE(SSL_get_shutdown(connection.secure()) & SSL_RECEIVED_SHUTDOWN, 0);
}

TEST_F(RestOverTls, OldVersionsAndPlainHttpAreNotSpoken) {
  start({.tls = files()});
  const auto context = client();
  SSL_CTX_set_security_level(context.get(), 0);
  SSL_CTX_set_min_proto_version(context.get(), TLS1_VERSION);
  SSL_CTX_set_max_proto_version(context.get(), TLS1_1_VERSION);
  EXPECT_EQ(status_of(context.get(), request("GET", "/healthz")), -1);
  Connection plain(port_);
  plain.send(request("GET", "/healthz"));
  EXPECT_FALSE(plain.read());
  EXPECT_EQ(status_of(client().get(), request("GET", "/healthz")), 200);
}

TEST_F(RestOverTls, Version12IsStillSpoken) {
  start({.tls = files()});
  const auto context = client();
  SSL_CTX_set_max_proto_version(context.get(), TLS1_2_VERSION);
  EXPECT_EQ(status_of(context.get(), request("GET", "/healthz")), 200);
}

TEST_F(RestOverTls, WhoNeverGreetsIsLeft) {
  start({.header_timeout_s = 0.2, .tls = files()});
  Connection silent(port_);
  EXPECT_TRUE(silent.is_closed());
  Connection slow(port_);
  slow.send("\x16\x03\x01\x02");
  EXPECT_TRUE(slow.is_closed());
  EXPECT_EQ(status_of(client().get(), request("GET", "/healthz")), 200);
}

TEST_F(RestOverTls, TheJobOfAWaitingClientThatLeavesIsDismissed) {
  start({.tls = files()});
  const auto context = client();
  Connection connection(port_, context.get());
  connection.send(request("POST", "/processes/heal/execution", kBox));
  std::vector<Job> open;
  while ((open = must(service_.jobs().list({}))).empty())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  connection.leave();
  while (!is_final(must(service_.jobs().get(open[0].id)).state))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(must(service_.jobs().get(open[0].id)).state, JobState::Dismissed);
}

TEST_F(RestOverTls, RenewedFilesAreUsedForNewConnectionsAndBrokenOnesNever) {
  start({.tls = files()});
  const auto before = client();
  Connection open(port_, before.get());
  ASSERT_TRUE(open.greeted());
  write_certificate(folder_.path(), make_certificate());
  const auto after = client();
  EXPECT_EQ(status_of(after.get(), request("GET", "/healthz")), -1);
  must(server_->reload_tls());
  EXPECT_EQ(status_of(after.get(), request("GET", "/healthz")), 200);
  open.send(request("GET", "/healthz"));
  EXPECT_EQ(open.read()->status, 200);

  std::ofstream(folder_ / "key.pem") << "nonsense";
  const auto refused = server_->reload_tls();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("key.pem"));
  EXPECT_EQ(status_of(after.get(), request("GET", "/healthz")), 200);
}

TEST_F(RestOverTls, FilesThatCannotBeUsedAreNamedAndNothingStarts) {
  const auto other = make_certificate();
  std::ofstream(folder_ / "other.pem") << other.key_pem;
  for (const auto& [wrong, named] :
       {std::pair(TlsFiles{folder_ / "none.pem", folder_ / "key.pem"}, "none.pem"),
        std::pair(TlsFiles{folder_ / "certificate.pem", folder_ / "none.pem"}, "none.pem"),
        std::pair(TlsFiles{folder_ / "key.pem", folder_ / "key.pem"}, "certificate"),
        std::pair(TlsFiles{folder_ / "certificate.pem", folder_ / "other.pem"}, "other.pem")}) {
    RestServer server(service_.jobs(), service_.metrics(), {.port = 0, .tls = wrong});
    const auto started = server.start();
    ASSERT_FALSE(started) << named;
    EXPECT_EQ(started.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(started.error().message, HasSubstr(named));
  }
}

}  // namespace
}  // namespace citymesh
