// One period of the device loop at times that the test sets.
#include "peer/haptics/servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "peer/haptics/device_loop.h"
#include "servo_kit.h"

namespace slosh {
namespace {

using test::kTick;
using test::ServoKit;

Pose at(double x) {
  Pose pose;
  pose.position.x = x;
  return pose;
}

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
  kit.tick(0.05);
  EXPECT_NEAR(kit.device->last.force.x, 1000.0 * 2.0 * kTick, 1e-6) << "two ticks ahead and no more";
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

TEST(Servo, PostsThePoseWithTheTickItHadSeen) {
  ServoKit kit;
  kit.publish(0.010);
  kit.device->next.pose = at(0.2);
  kit.tick(0.0105);
  ASSERT_TRUE(kit.channel.pose(0).update());
  const PoseMessage& m = kit.channel.pose(0).front();
  EXPECT_EQ(m.tick_ack, 5u);
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

TEST(Servo, TakingHoldFarFromTheGripRampsIn) {
  ServoKit kit;
  kit.device->next.pose = at(0.1);
  kit.publish(0.0);
  kit.tick(0.0);
  EXPECT_EQ(kit.device->last.force.x, 0.0);
  kit.publish(0.25);
  kit.tick(0.25);
  EXPECT_NEAR(kit.device->last.force.x, -50.0, 1e-6);
  kit.publish(0.6);
  kit.tick(0.6);
  EXPECT_NEAR(kit.device->last.force.x, -100.0, 1e-6);
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
  DeviceLimits limits;
  limits.max_force = 8.0;
  ServoKit kit(limits);
  kit.publish(0.0);
  kit.tick(0.0);
  kit.device->next.pose = at(0.05);
  kit.tick(0.001);
  EXPECT_NEAR(kit.device->last.force.x, -8.0, 1e-9);
  EXPECT_NE(kit.servo->status() & kStatusForceLimited, 0u);
}

TEST(Servo, FadesOutWhenBodyStatesStop) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.publish(kTick);  // the world runs
  kit.device->next.pose = at(0.01);
  kit.tick(0.05);
  EXPECT_NEAR(kit.device->last.force.x, -10.0, 1e-9) << "held";
  kit.tick(kTick + kHoldStale + 0.5 * kFadeStale);
  EXPECT_NEAR(kit.device->last.force.x, -5.0, 1e-6) << "half faded";
  kit.tick(1.0);
  EXPECT_EQ(kit.device->last.force.x, 0.0);
}

TEST(Servo, WaitsAtFullForceForTheFirstStepAndLetsGoWhenTheWorldStops) {
  ServoKit kit;
  kit.tick(0.0);
  kit.device->next.pose = at(0.01);
  kit.tick(5.0);  // the world has not begun; drawing was being set up
  EXPECT_NEAR(kit.device->last.force.x, -10.0, 1e-9);
  ServoSample sample;
  while (kit.servo->samples().pop(sample)) {
  }
  kit.publish(1.0, {}, {}, 0.0);  // the last state: stopped
  kit.tick(1.0);
  EXPECT_EQ(kit.device->last.force.x, 0.0);
  EXPECT_FALSE(kit.servo->samples().pop(sample)) << "the end is not felt as a drop to zero";
}

TEST(Freshness, WaitsLongerForASlowWorld) {
  EXPECT_EQ(freshness(0.05, 0.001), 1.0);
  EXPECT_EQ(freshness(0.05 + kHoldStale + kFadeStale, 0.001), 0.0);
  EXPECT_EQ(freshness(0.5, 0.2), 1.0) << "a step of 0.2 s may be 0.5 s late";
}

TEST(Servo, SamplesAtItsIntervalOfSimulatedTime) {
  ServoKit kit;
  for (int i = 0; i <= 100; ++i) {
    kit.publish(0.001 * i);
    kit.tick(0.001 * i);
  }
  ServoSample sample;
  int count = 0;
  double last = -1.0;
  while (kit.servo->samples().pop(sample)) {
    EXPECT_GT(sample.time, last);
    last = sample.time;
    count += 1;
  }
  EXPECT_NEAR(count, 51, 1) << "0.1 s every 2 ms";
  EXPECT_EQ(kit.servo->samples_lost(), 0u);
}

TEST(Servo, CountsSamplesThatNobodyTook) {
  ServoOptions options;
  options.sample_capacity = 4;
  ServoKit kit({}, options);
  for (int i = 0; i <= 40; ++i) {
    kit.publish(0.002 * i);
    kit.tick(0.002 * i);
  }
  EXPECT_EQ(kit.servo->samples_lost(), 37u);
}

TEST(DeviceLoop, TicksOnItsOwnThreadAndReportsItsJitter) {
  ServoKit kit;
  DeviceLoop loop(*kit.servo);
  loop.start();
  EXPECT_TRUE(kit.channel.pose(0).update()) << "every pose has been posted when start() returns";
  while (loop.rate() == 0.0) std::this_thread::yield();  // a quarter of a second
  loop.stop();
  const DeviceLoopReport& report = loop.report();
  EXPECT_GT(report.ticks, 10u);
  EXPECT_EQ(report.period.count() + 1, report.ticks);
  RecordProperty("period_p99_us", static_cast<int>(1e6 * report.period.percentile(0.99)));
  std::printf("device loop: %llu ticks, period p50 %.1f µs, p99 %.1f µs, longest %.1f µs, %llu missed, %s\n",
              static_cast<unsigned long long>(report.ticks), 1e6 * report.period.percentile(0.5),
              1e6 * report.period.percentile(0.99), 1e6 * report.period.max(),
              static_cast<unsigned long long>(report.missed), report.scheduler().c_str());
}

}  // namespace
}  // namespace slosh
