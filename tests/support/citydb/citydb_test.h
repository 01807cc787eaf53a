#pragma once

#include <gtest/gtest.h>

#include "tests/support/citydb/test_server.h"

namespace citymesh::citydb_support {

/// A test that needs a database; skipped where PostgreSQL or PostGIS is not installed.
class CityDbTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto server = TestServer::get();
    if (!server && server.error().code == ErrorCode::Unimplemented)
      GTEST_SKIP() << server.error().message;
    ASSERT_TRUE(server) << server.error().message;
    server_ = *server;
  }

  TestServer& server() { return *server_; }

 private:
  TestServer* server_ = nullptr;
};

}  // namespace citymesh::citydb_support
