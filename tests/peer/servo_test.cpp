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
    // The spring's end goes at no more than kLetInSpeed; over the first half second the share that is felt
    // rises too, by which time the spring is 37 N at most; and the damper adds its own.
    EXPECT_GE(kit.device->last.force.x - last, -(1000.0 * kLetInSpeed + 37.0 / 0.5) * 0.001 - 0.05) << i;
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

TEST(Servo, FadesOutWhenBodyStatesStop) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.publish(kTick);  // the world runs
  kit.device->next.pose = at(0.01);
  kit.tick(kTick);
  for (int ms = 1; ms <= 1000; ++ms) {
    const double age = 0.001 * ms;
    kit.tick(kTick + age);
    const double expected = -10.0 * std::clamp(1.0 - (age - kHoldStale) / kFadeStale, 0.0, 1.0);
    ASSERT_NEAR(kit.device->last.force.x, expected, 1e-6) << "held, then faded: " << ms << " ms";
  }
}

TEST(Servo, SilenceStretchesNoSpring) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.publish(kTick);
  kit.device->next.pose = at(0.01);
  kit.tick(kTick);
  double most = 0.0;
  for (int ms = 1; ms <= 400; ++ms) {
    kit.device->next.pose = at(0.01 + 0.0005 * ms);  // the hand goes on, and nobody says where the grip is
    kit.tick(kTick + 0.001 * ms);
    // What two ticks and a period carry the hand on by is still believed.
    most = std::max(most, std::abs(kit.device->last.force.x));
  }
  EXPECT_LT(most, 10.0 + 1000.0 * 0.0005 * 5.0 + 0.1);
  EXPECT_EQ(kit.device->last.force.x, 0.0);
}

/// In every state that a world can be in, silence ends the force.
struct Standing {
  const char* what;
  std::uint32_t run;
  double time;
  double rate;
};

class Silence : public ::testing::TestWithParam<Standing> {};

TEST_P(Silence, EndsTheForceWithin400Milliseconds) {
  const Standing& world = GetParam();
  ServoKit kit;
  const auto say = [&](double wall) {
    BodyMessage& message = kit.channel.bodies().back();
    message = ServoKit::first();
    message.run = world.run;
    message.rate = world.rate;
    message.stamp_ns = to_nanoseconds(wall);
    message.bodies.tick = static_cast<std::uint64_t>(std::lround(world.time / kTick));
    message.bodies.time = world.time;
    kit.channel.bodies().publish();
  };
  double wall = 10.0;
  for (int i = 0; i < 1500; ++i, wall += 0.001) {
    say(wall);
    if (i == 1) kit.device->next.pose = at(0.01);
    kit.tick(wall);
  }
  const bool paused = world.rate <= 0.0 && world.time > 0.0;
  EXPECT_NEAR(kit.device->last.force.x, paused ? 0.0 : -10.0, 1e-6) << world.what;
  double last = kit.device->last.force.x;
  for (int ms = 0; ms < 400; ++ms, wall += 0.001) {
    kit.tick(wall);
    EXPECT_LT(std::abs(kit.device->last.force.x - last), 0.1) << "no jump";
    last = kit.device->last.force.x;
  }
  kit.tick(wall);
  EXPECT_EQ(kit.device->last.force.x, 0.0) << world.what << ": the link was cut 0.4 s ago";
}

INSTANTIATE_TEST_SUITE_P(Servo, Silence,
                         ::testing::Values(Standing{"waiting for the first step", 0, 0.0, 0.0},
                                           Standing{"standing after a reset", 3, 0.0, 0.0},
                                           Standing{"running", 0, 5.0, 1.0},
                                           Standing{"running after a reset", 2, 5.0, 1.0},
                                           Standing{"slow to the extreme", 0, 5.0, 1e-6},
                                           Standing{"paused", 0, 5.0, 0.0}),
                         [](const auto& test) {
                           std::string name = test.param.what;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST(Servo, WaitsAtFullForceForAsLongAsTheWorldSaysSo) {
  ServoKit kit;
  kit.tick(0.0);
  kit.device->next.pose = at(0.01);
  for (int ms = 1; ms <= 5000; ++ms) {
    if (ms % 100 == 0) kit.publish(0.0, {}, {}, 0.0);  // as a host does that waits for people
    kit.tick(0.001 * ms);
    ASSERT_NEAR(kit.device->last.force.x, -10.0, 1e-9) << ms;
  }
}

TEST(Servo, LetsGoOverATenthOfASecondWhenTheWorldStops) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.device->next.pose = at(0.01);
  kit.publish(kTick);
  kit.tick(kTick);
  EXPECT_NEAR(kit.device->last.force.x, -10.0, 1e-9);
  ServoSample sample;
  while (kit.servo->samples().pop(sample)) {
  }
  kit.publish(1.0, {}, {}, 0.0);  // the last state: stopped
  double last = -10.0;
  for (int ms = 0; ms <= 101; ++ms) {
    kit.tick(1.0 + 0.001 * ms);
    EXPECT_LE(kit.device->last.force.x - last, 0.1 + 1e-6);
    last = kit.device->last.force.x;
  }
  EXPECT_NEAR(last, 0.0, 1e-9);
  EXPECT_FALSE(kit.servo->samples().pop(sample)) << "the end is not felt as a drop to zero";
}

TEST(Servo, TheForceComesBackAsGentlyAsItWent) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.publish(kTick);
  kit.device->next.pose = at(0.01);
  for (int ms = 1; ms < 1000; ++ms) kit.tick(0.001 * ms);
  EXPECT_EQ(kit.device->last.force.x, 0.0) << "the link was gone for a second";
  double last = 0.0;
  for (int ms = 0; ms <= 4000; ++ms) {
    const double now = 1.0 + 0.001 * ms;
    kit.publish(now);
    kit.tick(now);
    EXPECT_LT(last - kit.device->last.force.x, 0.16) << "no jump at " << ms << " ms";
    last = kit.device->last.force.x;
    if (ms == 100) {
      EXPECT_GT(last, -1.0) << "not even over the time in which a still hand's force comes back";
    }
  }
  EXPECT_NEAR(last, -10.0, 1e-6);
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
      EXPECT_EQ(kit.device->last.force.x, 0.0) << "a hand far from the grip is let in again";
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

TEST(Servo, AHandThatIsNotOursIsLeftAlone) {
  Scene scene = test::one_grip_scene();
  scene.grips.push_back(scene.grips[0]);
  Channel channel(2, ServoKit::first(), 1 << 20);
  std::vector<std::unique_ptr<Device>> devices(2);
  auto made = std::make_unique<test::FakeDevice>();
  test::FakeDevice* const device = made.get();
  devices[1] = std::move(made);
  Servo servo(scene, std::move(devices), channel, {});
  EXPECT_FALSE(servo.holds(0));
  EXPECT_TRUE(servo.holds(1));
  EXPECT_EQ(servo.device(0), nullptr);
  servo.tick(1000);
  EXPECT_FALSE(channel.pose(0).update()) << "whoever holds it writes its pose";
  EXPECT_TRUE(channel.pose(1).update());
  EXPECT_EQ(device->last_time, 0.0);
  ServoSample sample;
  ASSERT_TRUE(servo.samples().pop(sample));
  EXPECT_EQ(sample.device, 1u);
  EXPECT_FALSE(servo.samples().pop(sample));
}

/// Tells when it is closed.
class ClosingDevice final : public Device {
 public:
  explicit ClosingDevice(int& closed) : closed_(closed) {}
  DeviceReport read(const DeviceMoment&) noexcept override { return {}; }
  void write(const Wrench& on_hand) noexcept override { last = on_hand; }
  void close() override { closed_ += 1; }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  std::string kind() const override { return "closing"; }
  Wrench last;

 private:
  int& closed_;
};

TEST(Servo, DevicesComeAndGoWhileItRuns) {
  Scene scene = test::one_grip_scene();
  Channel channel(1, ServoKit::first(), 1 << 20);
  Servo servo(scene, {}, channel, {});
  EXPECT_FALSE(servo.holds_any());
  servo.tick(1000);
  EXPECT_FALSE(channel.pose(0).update());

  int closed = 0;
  (void)servo.set_device(0, std::make_unique<ClosingDevice>(closed));
  EXPECT_TRUE(servo.holds_any());
  servo.tick(2000);
  EXPECT_TRUE(channel.pose(0).update());

  (void)servo.set_device(0, nullptr);
  EXPECT_FALSE(servo.holds(0));
  EXPECT_EQ(closed, 0) << "the loop may still be using it";
  servo.tick(3000);
  EXPECT_FALSE(channel.pose(0).update());
  (void)servo.set_device(0, std::make_unique<ClosingDevice>(closed));
  EXPECT_EQ(closed, 1) << "now it is free";
  servo.tick(4000);
  EXPECT_TRUE(channel.pose(0).update());
  servo.close_devices();
  EXPECT_EQ(closed, 2);
}

TEST(Servo, DevicesAreExchangedUnderARunningLoop) {
  Scene scene = test::one_grip_scene();
  Channel channel(1, ServoKit::first(), 1 << 20);
  Servo servo(scene, {}, channel, {});
  DeviceLoop loop(servo, 0.0001);
  loop.start();
  int closed = 0;
  for (int i = 0; i < 300; ++i) {
    (void)servo.set_device(0, std::make_unique<ClosingDevice>(closed));
    if (i % 3 == 0) (void)servo.set_device(0, nullptr);
    std::this_thread::yield();
  }
  loop.stop();
  servo.close_devices();
  EXPECT_GE(closed, 300) << "none is forgotten";
}

TEST(Freshness, WaitsLongerForASlowWorld) {
  EXPECT_EQ(freshness(0.05, 0.001), 1.0);
  EXPECT_EQ(freshness(0.05 + kHoldStale + kFadeStale, 0.001), 0.0);
  EXPECT_EQ(freshness(0.15, 0.04), 1.0) << "a step of 0.04 s may be 0.15 s late";
  EXPECT_EQ(freshness(0.2, 1e6), 1.0);
  EXPECT_EQ(freshness(kSilent, 1e6), 0.0) << "but no world is so slow that a force stays";
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
  ServoKit kit(limits_without_a_hand(), options);
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
