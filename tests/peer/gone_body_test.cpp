// A hand whose body left the world, or whose grip is taken from it: no spring to nothing, and no step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "servo_kit.h"

namespace slosh {
namespace {

using test::at;
using test::ServoKit;

/// N/s and N/s² of a device that a hand feels.
DeviceLimits felt_limits() {
  DeviceLimits limits = limits_without_a_hand();
  limits.max_force = 12.0;
  limits.max_force_rate = 2000.0;
  limits.max_force_jerk = 2e5;
  return limits;
}

class GoneBody : public ::testing::Test {
 protected:
  /// A millisecond each, with the grip at rest at 0.
  void on(double seconds) {
    for (const double end = now_ + seconds; now_ < end - 1e-9; now_ += 0.001) {
      BodyMessage& message = kit_.channel.bodies().back();
      message = ServoKit::first();
      message.stamp_ns = to_nanoseconds(now_);
      message.rate = 1.0;
      message.run = run_;
      message.bodies.tick = static_cast<std::uint64_t>(std::lround(now_ / test::kTick));
      message.bodies.time = now_;
      message.bodies.bodies[0].gone = gone_;
      kit_.channel.bodies().publish();
      const double before = kit_.device->last.force.x;
      kit_.tick(now_);
      most_ = std::max(most_, std::abs(kit_.device->last.force.x));
      step_ = std::max(step_, std::abs(kit_.device->last.force.x - before));
    }
  }
  double force() const { return kit_.device->last.force.x; }

  ServoKit kit_{felt_limits()};
  double now_ = 0.0;
  bool gone_ = false;
  std::uint32_t run_ = 0;
  double most_ = 0.0, step_ = 0.0;  // N, from tick to tick the latter
};

TEST_F(GoneBody, IsNotHeldByAHandThatTakesHoldOfIt) {
  gone_ = true;
  kit_.device->next.engaged = false;
  on(0.1);
  kit_.device->next.engaged = true;
  kit_.device->next.pose = at(0.05);
  on(2.0);
  EXPECT_EQ(most_, 0.0);
  ASSERT_TRUE(kit_.channel.pose(0).update());
  EXPECT_FALSE(kit_.channel.pose(0).front().engaged)
      << "as the world has it: both take hold together once it is back";
  // The world is set back: it is there again.
  gone_ = false;
  run_ = 1;
  on(3.0);
  EXPECT_NEAR(force(), -12.0, 0.1);
  EXPECT_LE(step_, 2.0 + 1e-9);
}

TEST_F(GoneBody, ThatLeavesAHandTakesTheForceWithItByTheDevicesLimits) {
  kit_.device->next.pose = at(0.01);
  on(3.0);
  ASSERT_NEAR(force(), -10.0, 1e-6);
  gone_ = true;
  step_ = 0.0;
  on(0.02);
  EXPECT_EQ(force(), 0.0);
  EXPECT_LE(step_, 2.0 + 1e-9);
}

/// So it is with a host far away: it takes the grip from who held it, and no state says why.
TEST_F(GoneBody, WhoseGripIsTakenAwayEndsByTheDevicesLimitsToo) {
  kit_.device->next.pose = at(0.01);
  on(3.0);
  ASSERT_NEAR(force(), -10.0, 1e-6);
  ASSERT_TRUE(kit_.servo->set_device(0, nullptr));
  step_ = 0.0;
  on(0.02);
  EXPECT_EQ(force(), 0.0);
  EXPECT_LE(step_, 2.0 + 1e-9);
  while (kit_.channel.pose(0).update()) {
  }
  EXPECT_FALSE(kit_.channel.pose(0).front().engaged);
  on(0.01);
  EXPECT_FALSE(kit_.channel.pose(0).update()) << "and is spoken for no more";
}

}  // namespace
}  // namespace slosh
