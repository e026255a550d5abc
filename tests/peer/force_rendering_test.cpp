// What an engagement ramp gives towards a hand which stays.
#include "peer/haptics/force_rendering.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace slosh {
namespace {

constexpr CouplingGains kSprings{1000.0, 0.0, 10.0, 0.0};
constexpr double kCarried = 15.0;  // N on the hand, as it engages

class EngagementRamp : public ::testing::Test {
 protected:
  EngagementRamp() { felt.restart(kSprings, limits_without_a_hand(), true); }
  /// J over that time, with the grip where it is.
  double run(double seconds, const DeviceReport& hand) {
    GripState grip;
    grip.on_hand.force = {0.0, -kCarried, 0.0};
    double sum = 0.0;
    for (const double end = now + seconds; now < end; now += 0.001) {
      (void)felt.feel({1.0, true, false, false}, hand, grip, {now});
      sum += felt.ramp_work();
    }
    return sum;
  }
  static DeviceReport above(double way, double turn) {
    DeviceReport hand;
    hand.pose.position.y = way;
    hand.pose.orientation = rotate_by(hand.pose.orientation, {0.0, 0.0, turn});
    return hand;
  }
  ForceRendering felt{kSprings};
  double now = 0.0;
};

TEST_F(EngagementRamp, IsWhatTheSpringsHaveMoreInTheEnd) {
  const double stretched = 0.5 * kSprings.stiffness * 0.1 * 0.1;
  const double before = 0.5 * kCarried * kCarried / kSprings.stiffness;
  EXPECT_NEAR(run(4.0, above(0.1, 0.0)), stretched - before, 0.01 * stretched);
  EXPECT_NEAR(run(1.0, above(0.1, 0.0)), 0.0, 1e-6) << "it is in";
}

TEST_F(EngagementRamp, CountsTurnsToo) {
  const double turned = 0.5 * kSprings.rotational_stiffness * 0.3 * 0.3;
  EXPECT_NEAR(run(4.0, above(kCarried / kSprings.stiffness, 0.3)), turned, 0.01 * turned);
}

TEST_F(EngagementRamp, IsNothingOfAHandThatHoldsWhereItIsOrNotAtAll) {
  DeviceReport hand = above(kCarried / kSprings.stiffness, 0.0);
  EXPECT_EQ(run(0.1, hand), 0.0);
  hand.pose.position.y += 0.05;
  EXPECT_EQ(run(0.1, hand), 0.0) << "its own motion";
  hand.engaged = false;
  EXPECT_EQ(run(0.1, hand), 0.0);
  hand.engaged = true;
  EXPECT_EQ(run(0.001, hand), 0.0) << "nor as it takes hold";
}

/// A passivity controller (HeldBody) is before the limits: where it cuts a force at once, and lets it through
/// again, the device sees no more than its rate. What has no such limit sees all of it: a simulated person by
/// default, 4.9 N in 2 ms where one is lowered.
TEST(ForceRendering, AGuardThatCutsIsNoStepAtTheDevice) {
  DeviceLimits limits = limits_without_a_hand();
  for (const double rate : {2000.0, 2.0e5}) {
    limits.max_force_rate = rate;
    ForceRendering felt{kSprings};
    felt.restart(kSprings, limits, true);
    DeviceReport hand;
    hand.pose.position.y = kCarried / kSprings.stiffness;
    GripState grip;
    grip.on_hand.force = {0.0, -kCarried, 0.0};
    glm::dvec3 before(0.0);
    double most = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const bool cuts = i >= 1000 && i / 7 % 3 == 0;
      const auto guard = [&](const Wrench& wanted) { return cuts ? Wrench{} : wanted; };
      const glm::dvec3 force =
          felt.feel({1.0, true, false, false}, hand, grip, {0.001 * i}, guard).wrench.force;
      if (i > 100) most = std::max(most, glm::length(force - before));
      before = force;
    }
    EXPECT_NEAR(most, std::min(0.001 * rate, kCarried), 1e-6) << rate << " N/s";
  }
}

}  // namespace
}  // namespace slosh
