// One period of the device loop at times that the test sets.
#include "peer/haptics/servo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "peer/haptics/device_loop.h"
#include "servo_kit.h"

namespace slosh {
namespace {

using test::at;
using test::kTick;
using test::ServoKit;

TEST(Servo, ASpringPullsTheHandTowardsTheGrip) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);  // takes hold without stretch
  kit.device->next.pose = at(0.01);
  kit.tick(0.0);
  EXPECT_NEAR(kit.device->last.force.x, -10.0, 1e-9) << "1000 N/m over 10 mm, back towards the grip";
  EXPECT_EQ(kit.device->last.force.y, 0.0);
}

TEST(Servo, ADamperSeesTheDifferenceOfVelocities) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.device->next.twist.linear.y = 0.5;
  kit.tick(0.0);
  EXPECT_NEAR(kit.device->last.force.y, -10.0, 1e-9);
}

/// In a world at half its pace a hand of 0.25 m a second is one of 0.5 m a simulated second.
TEST(Servo, AHandIsAsFastAsASlowWorldSeesIt) {
  ServoKit kit;
  Twist moving;
  moving.linear.y = 0.5;
  kit.publish(1.0, {}, moving, 0.5);
  kit.device->next.twist.linear.y = 0.25;
  kit.tick(1.0);
  EXPECT_NEAR(kit.device->last.force.y, 0.0, 1e-9) << "hand and grip go together";
  kit.device->next.twist.linear.y = 0.0;
  kit.tick(1.0);
  EXPECT_NEAR(kit.device->last.force.y, 10.0, 1e-9) << "20 N·s/m in the world's time";
  kit.device->next.twist.linear.y = 0.25;
  kit.tick(1.0);
  ASSERT_TRUE(kit.channel.pose(0).update());
  EXPECT_NEAR(kit.channel.pose(0).front().twist.linear.y, 0.5, 1e-12) << "so the host is told";
  kit.device->next.twist.linear.y = 5.0;
  kit.publish(1.002, {}, {}, 0.05);
  for (int i = 0; i < 2000; ++i) kit.tick(1.002);
  ASSERT_TRUE(kit.channel.pose(0).update());
  EXPECT_LT(kit.channel.pose(0).front().twist.linear.y, 20.0) << "no faster than a host takes";
}

/// A damper of the world's time is the harder the slower the world is: no harder than the device holds.
TEST(Servo, ASlowWorldDampsNoHarderThanTheDeviceHolds) {
  DeviceLimits limits = limits_without_a_hand();
  limits.max_damping = 30.0;
  ServoKit kit(limits);
  kit.publish(1.0, {}, {}, 0.25);
  kit.tick(1.0);
  kit.device->next.twist.linear.y = 0.1;
  kit.tick(1.0);
  EXPECT_NEAR(kit.device->last.force.y, -3.0, 1e-9) << "30 N·s/m, where 20 of the world's would be 80";
}

TEST(Servo, WhoGoesByTheWorldsTimeIsAsFastAsTheySay) {
  ServoKit kit;
  ASSERT_TRUE(kit.servo->set_device(0, nullptr));
  auto made = std::make_unique<test::FakeDevice>();
  made->with_world = true;
  made->next.twist.linear.y = 0.5;
  test::FakeDevice* const device = made.get();
  ASSERT_TRUE(kit.servo->set_device(0, std::move(made)));
  Twist moving;
  moving.linear.y = 0.5;
  kit.publish(1.0, {}, moving, 0.25);
  kit.tick(1.0);
  kit.tick(1.0);
  EXPECT_NEAR(device->last.force.y, 0.0, 1e-9);
  ASSERT_TRUE(kit.channel.pose(0).update());
  EXPECT_EQ(kit.channel.pose(0).front().twist.linear.y, 0.5);
}

TEST(Servo, TheGripIsCarriedOnByItsTwistAtMostTwoTicks) {
  ServoKit kit;
  Twist moving;
  moving.linear.x = 1.0;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.device->next.twist = moving;  // no damper force
  kit.publish(0.0, at(0.0), moving);
  kit.tick(0.001);
  EXPECT_NEAR(kit.device->last.force.x, 1.0, 1e-6) << "1 mm ahead";
  kit.tick(2.0 * kTick);
  EXPECT_NEAR(kit.device->last.force.x, 1000.0 * 2.0 * kTick, 1e-6) << "two ticks ahead";
  kit.tick(0.05);
  EXPECT_NEAR(kit.device->last.force.x, 1000.0 * 2.0 * kTick, 1e-6) << "and no more";
}

TEST(Servo, SimulatedTimeFollowsTheWorldsPace) {
  ServoKit kit;
  kit.publish(1.0, {}, {}, 0.5);
  kit.tick(1.002);
  EXPECT_NEAR(kit.device->last_time, 1.001, 1e-9) << "a world at half speed";
  kit.tick(9.0);
  EXPECT_NEAR(kit.device->last_time, 1.0 + 2.0 * kTick, 1e-9);
  kit.publish(1.002, {}, {}, 0.5);
  kit.tick(1.002);
  EXPECT_NEAR(kit.device->last_time, 1.0 + 2.0 * kTick, 1e-9) << "time never goes back";
}

TEST(Servo, PostsThePoseWithTheMomentOfItsReading) {
  ServoKit kit;
  kit.publish(0.010);
  kit.device->next.pose = at(0.2);
  kit.tick(0.0105);
  ASSERT_TRUE(kit.channel.pose(0).update());
  const PoseMessage& m = kit.channel.pose(0).front();
  EXPECT_EQ(m.pose.position.x, 0.2);
  EXPECT_TRUE(m.engaged);
  EXPECT_EQ(m.stamp_ns, to_nanoseconds(0.0105));
}

TEST(Servo, AReportThatIsNoPoseIsNotUsed) {
  ServoKit kit;
  kit.publish(0.0);
  kit.device->next.pose = at(0.002);
  kit.device->next.twist.linear.x = 0.01;
  kit.tick(0.0);
  kit.device->next.pose.position.x = std::numeric_limits<double>::quiet_NaN();
  kit.tick(0.001);
  EXPECT_NE(kit.servo->status() & kStatusInputRejected, 0u);
  EXPECT_EQ(kit.servo->reports_rejected(), 1u);
  ASSERT_TRUE(kit.channel.pose(0).update());
  EXPECT_EQ(kit.channel.pose(0).front().pose.position.x, 0.002) << "the last good pose is held";
  EXPECT_EQ(kit.channel.pose(0).front().twist.linear.x, 0.0);
  EXPECT_TRUE(std::isfinite(glm::length(kit.device->last.force)));
}

TEST(Servo, ABodyStateThatIsNotFiniteGivesNoForce) {
  ServoKit kit;
  kit.publish(0.0, at(std::numeric_limits<double>::quiet_NaN()));
  kit.tick(0.0);
  EXPECT_EQ(kit.device->last.force, glm::dvec3(0.0));
  EXPECT_NE(kit.servo->status() & kStatusNonFinite, 0u);
}

TEST(Servo, TakingHoldFarFromTheGripPullsAtABoundedPace) {
  ServoKit kit;
  kit.device->next.pose = at(0.1);
  kit.publish(0.0);
  kit.tick(0.0);
  EXPECT_EQ(kit.device->last.force.x, 0.0);
  double last = 0.0;
  for (int i = 1; i <= 6000; ++i) {
    kit.publish(0.001 * i);
    kit.tick(0.001 * i);
    // The spring's end goes at no more than kRampSpeed; over the first half second the share that is felt
    // rises too, by which time the spring is 37 N at most; and the damper adds its own.
    EXPECT_GE(kit.device->last.force.x - last, -(1000.0 * kRampSpeed + 37.0 / 0.5) * 0.001 - 0.05) << i;
    last = kit.device->last.force.x;
    if (i == 100) {
      EXPECT_GT(last, -1.0) << "gently at first";
    }
  }
  EXPECT_NEAR(last, -100.0, 1e-6);
}

TEST(Servo, AHandThatIsSuddenlyElsewhereIsNotStruck) {
  ServoKit kit;
  double last = 0.0;
  for (int ms = 0; ms <= 3000; ++ms) {
    if (ms == 100) kit.device->next.pose = at(0.2);  // a tracker that lost its marker
    kit.publish(0.001 * ms);
    kit.tick(0.001 * ms);
    EXPECT_LT(std::abs(kit.device->last.force.x - last), 0.4) << ms << " ms; 200 N by the spring";
    last = kit.device->last.force.x;
  }
}

TEST(Servo, AWeightThatIsTakenOverIsFeltOverHalfASecond) {
  ServoKit kit;
  const auto hang = [&](double time) {
    BodyMessage& message = kit.channel.bodies().back();
    message = ServoKit::first();
    message.rate = 1.0;
    message.bodies.time = time;
    message.stamp_ns = to_nanoseconds(time);
    message.bodies.grips[0].pose = at(0.0);
    message.bodies.grips[0].on_hand.force.y = -15.0;  // the host's stand carries it
    kit.channel.bodies().publish();
    kit.tick(time);
  };
  hang(0.0);
  EXPECT_EQ(kit.device->last.force.y, 0.0);
  hang(0.05);
  EXPECT_GT(kit.device->last.force.y, -2.0);
}

TEST(Servo, AWeightThatHangsInTheHandIsFeltFromTheFirstTick) {
  ServoKit kit;
  BodyMessage& message = kit.channel.bodies().back();
  message = ServoKit::first();
  message.rate = 1.0;
  message.bodies.grips[0].pose.position.y = -0.013;
  message.bodies.grips[0].on_hand.force.y = -13.0;
  kit.channel.bodies().publish();
  kit.tick(0.0);
  EXPECT_NEAR(kit.device->last.force.y, -13.0, 1e-9);
}

TEST(Servo, StaysWithinTheDevicesLimitsAndSaysSo) {
  DeviceLimits limits = limits_without_a_hand();
  limits.max_force = 8.0;
  ServoKit kit(limits);
  kit.publish(0.0);
  kit.tick(0.0);
  kit.device->next.pose = at(0.025);
  kit.tick(0.001);
  EXPECT_NEAR(kit.device->last.force.x, -8.0, 1e-9);
  EXPECT_NE(kit.servo->status() & kStatusForceLimited, 0u);
}

TEST(Servo, SaysWhatIsAskedOfADeviceThatClipsAndForHowLongItDid) {
  DeviceLimits limits = limits_without_a_hand();
  limits.max_force = 8.0;
  ServoKit kit(limits);
  kit.publish(0.0);
  kit.tick(0.0);
  EXPECT_EQ(budget_line("left", kit.servo->budget(0)), "");
  kit.device->next.pose = at(0.025);  // 1000 N/m
  for (int i = 1; i <= 100; ++i) {
    kit.publish(0.001 * i);
    kit.tick(0.001 * i);
  }
  EXPECT_EQ(budget_line("left", kit.servo->budget(0)), "left: 25.0 N asked of a device of 8.0 N");
  EXPECT_NEAR(kit.servo->budget(0).clipped, 0.1, 1e-9);
  kit.device->next.pose = at(0.007);
  int shown = 0;  // ms that it can be read after it is over
  for (int i = 101; i <= 3000; ++i) {
    kit.publish(0.001 * i);
    kit.tick(0.001 * i);
    shown += budget_line("left", kit.servo->budget(0)).empty() ? 0 : 1;
  }
  EXPECT_NEAR(shown, 1500, 2);
  EXPECT_NEAR(kit.servo->budget(0).clipped, 0.1, 1e-9) << "the summary's";
}

TEST(Servo, AResetWorldStartsTimeAnewAndTheRecordGoesOn) {
  ServoKit kit;
  for (int i = 0; i <= 500; ++i) {
    kit.publish(0.002 * i);
    kit.tick(0.002 * i);
  }
  EXPECT_NEAR(kit.device->last_time, 1.0, 1e-9);
  for (int i = 0; i <= 2000; ++i) {
    BodyMessage& message = kit.channel.bodies().back();
    message = ServoKit::first();
    message.run = 1;
    message.rate = 1.0;
    message.stamp_ns = to_nanoseconds(1.002 + 0.002 * i);
    message.bodies.tick = static_cast<std::uint64_t>(i);
    message.bodies.time = 0.002 * i;
    kit.channel.bodies().publish();
    kit.device->next.pose = at(0.05);
    kit.tick(1.002 + 0.002 * i);
    if (i == 0) {
      EXPECT_NEAR(kit.device->last_time, 0.0, 1e-9) << "devices follow the world's time";
      EXPECT_EQ(kit.device->last.force.x, 0.0) << "a hand far from the grip re-engages";
    }
  }
  EXPECT_NEAR(kit.device->last.force.x, -50.0, 1e-6);
  ServoSample sample;
  double last = -1.0;
  int count = 0;
  while (kit.servo->samples().pop(sample)) {
    EXPECT_GT(sample.time, last) << "rows of a file rise";
    last = sample.time;
    count += 1;
  }
  EXPECT_NEAR(count, 2502, 2);
  EXPECT_NEAR(last, 5.002, 0.005);
}

TEST(Servo, JoiningALongRunningWorldTakesNoTimeToCatchUp) {
  ServoKit kit;
  kit.publish(5e6);
  kit.tick(5e6);
  kit.publish(5e6 + 0.002);
  kit.tick(5e6 + 0.002);
  ServoSample sample;
  int count = 0;
  while (kit.servo->samples().pop(sample)) count += 1;
  EXPECT_EQ(count, 2);
}

}  // namespace
}  // namespace slosh
