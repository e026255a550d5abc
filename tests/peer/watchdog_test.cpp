// A device loop that hangs: each device's own thread takes its force away, and nothing strikes the hand when
// it goes on.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "noted_writes.h"
#include "peer/haptics/device_loop.h"
#include "servo_kit.h"
#include "tests/support/comes.h"

namespace slosh {
namespace {

using test::comes;
using test::NotedWrites;
using test::NotingDevice;
using test::WrittenForce;

/// A device that the loop reads itself, and the world: while `hangs`, its read() does not return.
struct Hang {
  std::atomic<bool> hangs{false};
  std::atomic<bool> hung{false};
  std::atomic<std::uint64_t> ticks{0};
};
class HangingDevice final : public Device {
 public:
  HangingDevice(std::shared_ptr<Hang> hang, Channel& channel) : hang_(std::move(hang)), channel_(channel) {}
  DeviceReport read(const DeviceMoment&) override {
    hang_->hung = true;
    while (hang_->hangs) std::this_thread::sleep_for(std::chrono::microseconds(200));
    hang_->hung = false;
    test::publish_ahead(channel_, static_cast<int>(++hang_->ticks));
    return {};
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  std::string kind() const override { return "hanging"; }

 private:
  std::shared_ptr<Hang> hang_;
  Channel& channel_;
};

class Watchdog : public ::testing::Test {
 protected:
  void SetUp() override {
    channel_ = test::channel_of_two(scene_);
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::make_unique<NotingDevice>(noted_));
    devices.push_back(std::make_unique<HangingDevice>(hang_, *channel_));
    servo_ = std::make_unique<Servo>(scene_, std::move(devices), *channel_, ServoOptions{});
    loop_ = std::make_unique<DeviceLoop>(*servo_);
    loop_->start();
    // On the grip until it holds on, then off by 10 mm: 10 N.
    ASSERT_TRUE(comes([&] { return hang_->ticks > 300; }));
    for (int i = 1; i <= 100; ++i) {
      noted_->place = 1e-4 * i;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(comes([&] { return noted_->last() < -9.99; }));
  }
  void TearDown() override { hang_->hangs = false; }
  /// The loop stands still; when it was there last.
  std::int64_t hang() {
    const std::int64_t ns = steady_now_ns();
    hang_->hangs = true;
    EXPECT_TRUE(comes([&] { return hang_->hung.load(); }));
    return ns;
  }

  Scene scene_ = test::one_grip_scene();
  std::shared_ptr<NotedWrites> noted_ = std::make_shared<NotedWrites>();
  std::shared_ptr<Hang> hang_ = std::make_shared<Hang>();
  std::unique_ptr<Channel> channel_;
  std::unique_ptr<Servo> servo_;
  std::unique_ptr<DeviceLoop> loop_;
};

TEST_F(Watchdog, ALoopThatHangsLeavesNoDeviceWithAForce) {
  const std::int64_t hung_ns = hang();
  ASSERT_TRUE(comes([&] { return noted_->last() == 0.0; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const std::vector<WrittenForce> writes = noted_->since(hung_ns - to_nanoseconds(0.01));
  std::printf("zero %.0f ms after the loop hung; %.3f of what the device may be given at once\n",
              1e3 * test::zero_after(writes, hung_ns),
              test::steepest(writes, test::quick_arm().max_force_rate));
  // Whatever the machine does: what is written then is none, and as little as is left at its moment.
  for (const WrittenForce& write : writes) {
    const double age = to_seconds(write.ns - hung_ns);
    EXPECT_LE(glm::length(write.force), 10.01 * freshness(age - 0.02, 0.001)) << age << " s after";
  }
  EXPECT_LE(test::steepest(writes, test::quick_arm().max_force_rate), 1.0);
}

/// It hangs for as long as takes a half of the force, or for a second: what comes back begins with what is
/// left.
TEST_F(Watchdog, ALoopThatGoesOnAgainStrikesNoHand) {
  for (const double seconds : {0.05, 0.25, 1.0}) {
    const std::int64_t hung_ns = hang();
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    const std::int64_t on_ns = steady_now_ns();
    hang_->hangs = false;
    ASSERT_TRUE(
        comes([&] { return noted_->last() < -9.99 && steady_now_ns() > on_ns + to_nanoseconds(0.5); }));
    const std::vector<WrittenForce> writes = noted_->since(hung_ns - to_nanoseconds(0.01));
    double least = 10.0, soon = 0.0;
    for (const WrittenForce& write : writes) {
      const bool on = write.ns > on_ns;
      if (!on) least = std::min(least, glm::length(write.force));
      if (on && write.ns < on_ns + to_nanoseconds(0.02)) soon = std::max(soon, glm::length(write.force));
    }
    const double steepest = test::steepest(writes, test::quick_arm().max_force_rate);
    std::printf(
        "hung for %.2f s: down to %.1f N, %.1f N within 20 ms of its going on; %.3f of what the device may "
        "be given at once\n",
        seconds, least, soon, steepest);
    EXPECT_LE(steepest, 1.0) << seconds;
    EXPECT_LT(soon, least + 1.0) << seconds << " s: it comes over 0.2 s";
  }
}

}  // namespace
}  // namespace slosh
