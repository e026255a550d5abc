// The schedule against a clock that the test sets.
#include "host/pacer.h"

#include <gtest/gtest.h>

namespace slosh {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(Pacer, DeadlinesAreAPeriodApartFromTheStart) {
  Pacer pacer(0.002);
  pacer.restart(100 * kMs);
  EXPECT_EQ(pacer.next(100 * kMs).deadline_ns, 102 * kMs);
  EXPECT_EQ(pacer.next(103 * kMs).deadline_ns, 104 * kMs) << "a late step must not shift the next";
  EXPECT_EQ(pacer.next(104 * kMs).deadline_ns, 106 * kMs);
}

TEST(Pacer, RoundingDoesNotAddUp) {
  Pacer pacer(0.001 / 3.0);
  pacer.restart(0);
  std::int64_t deadline = 0;
  for (int i = 0; i < 300000; ++i) deadline = pacer.next(deadline).deadline_ns;
  EXPECT_NEAR(static_cast<double>(deadline), 100e9, 1.0);
}

TEST(Pacer, CatchesUpFromASmallDelay) {
  Pacer pacer(0.001);
  pacer.restart(0);
  const Pacer::Turn turn = pacer.next(40 * kMs);  // 39 ms behind: under the tolerance
  EXPECT_FALSE(turn.slipped);
  EXPECT_EQ(turn.deadline_ns, 1 * kMs);
  EXPECT_EQ(pacer.next(40 * kMs).deadline_ns, 2 * kMs);
  EXPECT_EQ(pacer.slips(), 0u);
}

TEST(Pacer, SlipsWhenTooFarBehindAndCountsIt) {
  Pacer pacer(0.001);
  pacer.restart(0);
  const Pacer::Turn turn = pacer.next(101 * kMs);  // 100 ms behind
  EXPECT_TRUE(turn.slipped);
  EXPECT_EQ(turn.deadline_ns, 101 * kMs);
  EXPECT_EQ(pacer.slips(), 1u);
  EXPECT_NEAR(pacer.slipped_seconds(), 0.1, 1e-9);
  const Pacer::Turn after = pacer.next(101 * kMs);
  EXPECT_FALSE(after.slipped);
  EXPECT_EQ(after.deadline_ns, 102 * kMs) << "the schedule goes on from the slip";
}

TEST(Pacer, AWorldAtHalfSpeedSlipsHalfTheTime) {
  Pacer pacer(0.001);
  pacer.restart(0);
  std::int64_t now = 0;
  for (int i = 0; i < 1000; ++i) {
    now = std::max(now, pacer.next(now).deadline_ns);
    now += 2 * kMs;  // a step of two periods
  }
  EXPECT_NEAR(pacer.slipped_seconds(), 1.0, 0.06);
}

TEST(Pacer, AnotherPeriodHoldsFromThereOn) {
  Pacer pacer(0.001);
  pacer.restart(0);
  EXPECT_EQ(pacer.next(0).deadline_ns, 1000000);
  pacer.set_period(0.001, 1500000);
  EXPECT_EQ(pacer.next(1500000).deadline_ns, 2000000) << "the same period moves nothing";
  pacer.set_period(0.01, 3000000);
  EXPECT_EQ(pacer.next(3000000).deadline_ns, 13000000);
  EXPECT_EQ(pacer.next(14000000).deadline_ns, 23000000);
  EXPECT_EQ(pacer.slips(), 0u);
}

}  // namespace
}  // namespace slosh
