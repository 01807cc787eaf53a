#include "services/telemetry/trace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace citymesh {
namespace {

using testing::MatchesRegex;

constexpr auto* kId = "4bf92f3577b34da6a3ce929d0e0e4736";

TEST(Trace, TheIdOfAValidHeaderIsTakenOver) {
  for (const auto* header :
       {"00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
        "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-00",
        "cc-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
        "cc-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01-what-the-future-holds"})
    EXPECT_EQ(trace_id_of(header), kId) << header;
}

TEST(Trace, AnythingElseIsIgnored) {
  for (const auto* header :
       {"", "00", "4bf92f3577b34da6a3ce929d0e0e4736",
        "00-4BF92F3577B34DA6A3CE929D0E0E4736-00f067aa0ba902b7-01",
        "00-00000000000000000000000000000000-00f067aa0ba902b7-01",
        "00-4bf92f3577b34da6a3ce929d0e0e4736-0000000000000000-01",
        "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-0x",
        "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01-more",
        "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01, 00-4bf92f3577b34da6a3ce929d0e0e4",
        "00_4bf92f3577b34da6a3ce929d0e0e4736_00f067aa0ba902b7_01",
        "cc-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01.more",
        "ff-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"}) {
    EXPECT_NE(trace_id_of(header), kId) << header;
    EXPECT_THAT(trace_id_of(header), MatchesRegex("[0-9a-f]{32}"));
  }
}

TEST(Trace, NewIdsDiffer) { EXPECT_NE(trace_id_of({}), trace_id_of({})); }

}  // namespace
}  // namespace citymesh
