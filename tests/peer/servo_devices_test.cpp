// Devices that come and go under the device loop, and the samples that it leaves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "peer/haptics/device_loop.h"
#include "peer/haptics/servo.h"
#include "servo_kit.h"

namespace slosh {
namespace {

using test::at;
using test::kTick;
using test::ServoKit;

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

/// A grip that is made stiffer or softer while it is held: gone over to, and never beyond what the device
/// holds.
TEST(Servo, AGripsStiffnessChangesLiveWithinTheDevicesLimits) {
  DeviceLimits limits = limits_without_a_hand();
  limits.max_stiffness = 1500.0;
  ServoKit kit(limits);
  kit.device->next.pose = test::at(-0.001);
  kit.device->next.engaged = true;
  int tick = 0;
  const auto felt_after = [&](int ticks) {
    for (const int end = tick + ticks; tick < end; ++tick) {
      if (tick % 2 == 0) kit.publish(0.001 * tick);
      kit.tick(0.001 * tick);
    }
    return kit.device->last.force.x;
  };
  const double scenes = felt_after(1000);  // 1 mm at 1000 N/m, but for what the engagement keeps of the start
  ASSERT_GT(scenes, 0.0);
  kit.servo->set_stiffness(0, 0.25);
  const double at_once = felt_after(1);
  EXPECT_GT(at_once, 0.98 * scenes) << "gone over to";
  EXPECT_NEAR(felt_after(500), 0.25 * scenes, 1e-6 * scenes);
  kit.servo->set_stiffness(0, 4.0);
  EXPECT_NEAR(felt_after(6000), 1.5 * scenes, 1e-6 * scenes) << "the device holds 1500 N/m";
  kit.servo->set_stiffness(0, 1.0);
  EXPECT_NEAR(felt_after(6000), scenes, 1e-6 * scenes);
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
