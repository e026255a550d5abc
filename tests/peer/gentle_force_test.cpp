// However a hand comes to have force again: gently, over the device's time, without a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "servo_kit.h"

namespace slosh {
namespace {

using test::at;
using test::ServoKit;

constexpr double kPull = -10.0;  // N: what the hand carries; it holds on quietly from the first tick

/// A device as there are some, in a hand that carries 10 N.
class GentleForce : public ::testing::Test {
 protected:
  static DeviceLimits limits() {
    DeviceLimits l = limits_without_a_hand();
    l.max_force = 12.0;
    l.max_force_rate = 2000.0;
    l.max_force_jerk = DeviceLimits{}.max_force_jerk;
    l.max_torque_jerk = DeviceLimits{}.max_torque_jerk;
    l.engagement_time = DeviceLimits{}.engagement_time;
    return l;
  }
  ServoKit kit{limits()};
  double wall = 1.0, time = 0.0;
  double rate = 1.0;
  std::uint32_t run = 0;
  bool linked = true;
  double last = 0.0, slope = 0.0;
  double steepest = 0.0, sharpest = 0.0;  // N/s, N/s²

  void SetUp() override { kit.device->next.pose = at(0.01); }
  double force() const { return kit.device->last.force.x; }
  void on(double seconds) {
    for (int left = static_cast<int>(std::lround(1e3 * seconds)); left > 0; --left) {
      wall += 0.001;
      time += 0.001 * rate;
      if (linked) {
        BodyMessage& message = kit.channel.bodies().back();
        message = ServoKit::first();
        message.run = run;
        message.rate = rate;
        message.stamp_ns = to_nanoseconds(wall);
        message.bodies.tick = 1 + static_cast<std::uint64_t>(1e3 * time);
        message.bodies.time = time;
        message.bodies.grips[0].on_hand.force.x = kPull;
        kit.channel.bodies().publish();
      }
      kit.tick(wall);
      const double now = force();
      steepest = std::max(steepest, std::abs(now - last) / 0.001);
      sharpest = std::max(sharpest, std::abs((now - last) / 0.001 - slope) / 0.001);
      slope = (now - last) / 0.001;
      last = now;
    }
  }
  /// The hand had nothing; now it has it again.
  void expect_gentle(const char* what) {
    EXPECT_NEAR(force(), 0.0, 1e-6) << what;
    on(0.2);
    EXPECT_LT(std::abs(force()), 0.05 * std::abs(kPull)) << what;
    on(0.8);
    EXPECT_NEAR(force() / kPull, 0.5, 0.15) << what;
    on(1.2);
    EXPECT_NEAR(force(), kPull, 0.05 * std::abs(kPull)) << what;
    std::printf("%-34s at most %6.1f N/s and %8.0f N/s²\n", what, steepest, sharpest);
    EXPECT_LE(steepest, limits().max_force_rate * 1.001) << what;
    EXPECT_LE(sharpest, limits().max_force_jerk * 1.001) << what;
    steepest = sharpest = 0.0;
  }
};

TEST_F(GentleForce, HoweverItComesBack) {
  expect_gentle("at the start");

  rate = 0.0;
  on(1.0);
  rate = 1.0;
  expect_gentle("the world goes on");

  linked = false;
  on(1.0);
  linked = true;
  expect_gentle("contact is found again");

  kit.device->next.heard = false;
  on(1.0);
  kit.device->next.heard = true;
  expect_gentle("the device speaks again");

  kit.device->next.engaged = false;
  on(0.5);
  kit.device->next.engaged = true;
  expect_gentle("the hand takes hold again");

  ASSERT_TRUE(kit.servo->set_device(0, nullptr));
  on(0.1);
  EXPECT_EQ(force(), 0.0) << "a device that is taken away is left with no force";
  auto made = std::make_unique<test::FakeDevice>();
  made->limit = limits();
  made->next.pose = at(0.01);
  kit.device = made.get();
  ASSERT_TRUE(kit.servo->set_device(0, std::move(made)));
  last = slope = steepest = sharpest = 0.0;
  expect_gentle("another device");
}

/// A reset and a leap take what was there away over a tenth of a second first.
TEST_F(GentleForce, AResetAndALeapGiveItUpAndBeginAnew) {
  on(3.0);
  for (const bool reset : {true, false}) {
    if (reset) {
      run += 1;
      time = 0.0;
    } else {
      kit.device->next.pose = at(0.2);
      on(0.02);
      kit.device->next.pose = at(0.01);
    }
    steepest = sharpest = 0.0;
    on(0.3);
    EXPECT_LT(std::abs(force()), 1.0) << reset;
    on(0.7);
    EXPECT_LT(std::abs(force()), 8.0) << reset;
    on(4.0);
    EXPECT_GT(std::abs(force()), 9.0) << reset;
    EXPECT_LE(steepest, limits().max_force_rate * 1.001) << reset;
    EXPECT_LE(sharpest, limits().max_force_jerk * 1.001) << reset;
  }
}

/// A word that is a little late takes a little force, and gives it back as gently.
TEST_F(GentleForce, AShortSilenceTakesAndGivesBackAPart) {
  on(3.0);
  linked = false;
  on(0.18);
  linked = true;
  const double least = std::abs(force());
  EXPECT_GT(least, 0.3 * std::abs(kPull));
  EXPECT_LT(least, 0.95 * std::abs(kPull));
  on(0.2);
  EXPECT_LT(std::abs(force()), least + 2.0);
  on(2.0);
  EXPECT_NEAR(force(), kPull, 0.1);
}

/// While it gets force a hand is held back a little against its own motion, and never pushed.
TEST_F(GentleForce, WhileItGetsForceItsMotionIsDamped) {
  kit.device->next.pose = at(0.0);
  kit.device->next.twist.linear.y = 0.1;
  on(0.1);
  const double damped = kit.device->last.force.y;
  EXPECT_LT(damped, -0.05);
  EXPECT_GT(damped, -0.1 * ForceRendering::kMaxRampDamping);
}

}  // namespace
}  // namespace slosh
