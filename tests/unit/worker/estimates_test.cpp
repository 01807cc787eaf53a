#include "services/worker/estimates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <latch>

namespace citymesh {
namespace {

using testing::HasSubstr;

/// Selects until it is stopped or let go.
class SlowSource final : public CitySource {
 public:
  SlowSource(std::latch& asked, std::latch& go_on) : asked_(asked), go_on_(go_on) {}

  Result<Selection> select(const BuildingQuery&, const RunContext& context) override {
    asked_.count_down();
    while (!go_on_.try_wait())
      if (context.stopped()) return fail(ErrorCode::Cancelled, "stopped");
    Selection selection;
    selection.buildings = 7;
    return selection;
  }
  Result<void> read(const BuildingQuery&, const Selection&, const BuildingSink&,
                    const RunContext&) override {
    return fail(ErrorCode::Internal, "an estimate reads nothing");
  }

 private:
  std::latch& asked_;
  std::latch& go_on_;
};

SourceFactory slow(std::latch& asked, std::latch& go_on) {
  return [&asked, &go_on] {
    return Result<std::unique_ptr<CitySource>>(std::make_unique<SlowSource>(asked, go_on));
  };
}

TEST(EstimatesTest, AreMadeWithoutReadingBuildings) {
  std::latch asked(1), go_on(0);
  const auto estimates = estimator(slow(asked, go_on));
  const auto expected = estimates("validate", "{}");
  ASSERT_TRUE(expected) << expected.error().message;
  EXPECT_EQ(expected->buildings, 7u);
  EXPECT_GT(expected->triangles, 7u) << "of a source that cannot tell";
}

TEST(EstimatesTest, MoreThanTheLimitAtATimeAreRefusedAndTheNextIsMade) {
  std::latch asked(1), go_on(1);
  const auto estimates = estimator(slow(asked, go_on), {.at_once = 1});
  auto first = std::async(std::launch::async, [&] { return estimates("validate", "{}"); });
  asked.wait();
  const auto refused = estimates("validate", "{}");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
  go_on.count_down();
  EXPECT_TRUE(first.get());
}

TEST(EstimatesTest, OneThatTakesTooLongIsStopped) {
  std::latch asked(1), never(1);
  const auto estimates = estimator(slow(asked, never), {.longest_ms = 1});
  const auto refused = estimates("validate", "{}");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::DeadlineExceeded);
  EXPECT_THAT(refused.error().message, HasSubstr("0.001 s"));
}

TEST(EstimatesTest, ASourceThatCannotBeOpenedSaysWhy) {
  const auto estimates = estimator([]() -> Result<std::unique_ptr<CitySource>> {
    return fail(ErrorCode::Unavailable, "the database is away");
  });
  for (int i = 0; i < 10; ++i) {
    const auto refused = estimates("validate", "{}");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "the database is away");
  }
}

}  // namespace
}  // namespace citymesh
