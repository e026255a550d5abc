#include <gtest/gtest.h>

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
