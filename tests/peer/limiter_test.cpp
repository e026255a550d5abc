#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "peer/haptics/force_limiter.h"

namespace slosh {
namespace {

DeviceLimits limits() {
  DeviceLimits l = limits_without_a_hand();
  l.max_force = 10.0;
  l.max_torque = 0.5;
  l.max_force_rate = 1000.0;  // 1 N a millisecond
  l.max_torque_rate = 100.0;
  return l;
}

TEST(ForceLimiter, PassesWhatIsWithinTheLimits) {
  ForceLimiter limiter(limits());
  const ForceLimiter::Outcome outcome = limiter.limit({{0.5, 0, 0}, {0, 0.05, 0}}, 0.001);
  EXPECT_FALSE(outcome.limited);
  EXPECT_EQ(outcome.wrench.force.x, 0.5);
  EXPECT_EQ(outcome.wrench.torque.y, 0.05);
}

TEST(ForceLimiter, ScalesToTheLargestForceAndKeepsItsDirection) {
  ForceLimiter limiter(limits());
  ForceLimiter::Outcome outcome;
  for (int i = 0; i < 20; ++i) outcome = limiter.limit({{30.0, 40.0, 0.0}, {0, 0, 2.0}}, 0.001);
  EXPECT_TRUE(outcome.limited);
  EXPECT_NEAR(outcome.wrench.force.x, 6.0, 1e-9);
  EXPECT_NEAR(outcome.wrench.force.y, 8.0, 1e-9);
  EXPECT_NEAR(outcome.wrench.torque.z, 0.5, 1e-9);
}

TEST(ForceLimiter, RisesAndFallsNoFasterThanItsRate) {
  ForceLimiter limiter(limits());
  double last = 0.0;
  for (int i = 1; i <= 5; ++i) {
    const ForceLimiter::Outcome outcome = limiter.limit({{5.0, 0, 0}, {}}, 0.001);
    EXPECT_NEAR(outcome.wrench.force.x - last, 1.0, 1e-9);
    EXPECT_EQ(outcome.limited, i < 5);
    last = outcome.wrench.force.x;
  }
  EXPECT_NEAR(limiter.limit({}, 0.001).wrench.force.x, 4.0, 1e-9);
}

/// Towards a force that stands, leaps or swings: no rate and no jerk beyond the limits, no way past what is
/// wanted.
TEST(ForceLimiter, TheRateChangesNoFasterThanTheJerk) {
  DeviceLimits l = limits();
  l.max_force_rate = 500.0;
  l.max_force_jerk = 2e4;
  ForceLimiter limiter(l);
  constexpr double kPeriod = 0.001;
  double last = 0.0, rate = 0.0, most = 0.0;
  int reached = 0;
  for (int i = 0; i < 1000; ++i) {
    const double wanted = i < 400 ? 8.0 : i < 600 ? -2.0 : 0.5 * std::sin(60.0 * kPeriod * i);
    const double now = limiter.limit({{wanted, 0.0, 0.0}, {}}, kPeriod).wrench.force.x;
    const double is = (now - last) / kPeriod;
    EXPECT_LE(std::abs(is), 500.0 + 1e-6) << i;
    EXPECT_LE(std::abs(is - rate), 20.0 + 1e-6) << i;
    if (reached == 0 && now == 8.0) reached = i;
    most = std::max(most, now);
    last = now;
    rate = is;
    if (i >= 700) {
      EXPECT_NEAR(now, wanted, 1e-9) << "what is gentle passes as it is";
    }
  }
  EXPECT_LE(most, 8.0 + 1e-9);
  EXPECT_NEAR(reached, 41, 3) << "16 ms at 500 N/s, 25 ms to get there and to stop";
}

TEST(ForceLimiter, NothingNonFiniteGetsThrough) {
  ForceLimiter limiter(limits());
  limiter.limit({{1.0, 0, 0}, {}}, 0.001);
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  for (const double value : bad) {
    const ForceLimiter::Outcome outcome = limiter.limit({{}, {0, value, 0}}, 0.001);
    EXPECT_TRUE(outcome.non_finite);
    EXPECT_EQ(outcome.wrench.force, glm::dvec3(0.0));
    EXPECT_EQ(outcome.wrench.torque, glm::dvec3(0.0));
  }
}

}  // namespace
}  // namespace slosh
