// The device loop's tick asks nothing of the heap and takes no lock, whatever is in its hands: every call of
// this program is counted (tests/support/thread_calls.h).
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <thread>

#include "peer/devices/operator_device.h"
#include "peer/devices/plugin_device.h"
#include "peer/haptics/mouse_device.h"
#include "peer/haptics/script_device.h"
#include "peer/haptics/shared_handle.h"
#include "servo_kit.h"
#include "swinging_host.h"
#include "tests/peer/devices/own_folder.h"
#include "tests/support/thread_calls.h"

namespace slosh {
namespace {

using test::thread_calls;
using test::ThreadCalls;

constexpr std::int64_t ns(int ms) {
  return std::int64_t{1'000'000} * ms;
}

/// What `ticks` ticks of the loop, a ms apart, ask for. `before`: of the rest of the world before each,
/// uncounted.
ThreadCalls asked_for(Servo& servo, int ticks, const std::function<void(int)>& before) {
  ThreadCalls sum;
  for (int i = 0; i < ticks; ++i) {
    before(i);
    const ThreadCalls begin = thread_calls();
    servo.tick(ns(i) + 300'000);
    const ThreadCalls now = thread_calls() - begin;
    sum.allocations += now.allocations;
    sum.frees += now.frees;
    sum.locks += now.locks;
  }
  return sum;
}

void expect_nothing(const ThreadCalls& calls) {
  EXPECT_EQ(calls.allocations, 0u);
  EXPECT_EQ(calls.frees, 0u);
  EXPECT_EQ(calls.locks, 0u);
}

BodyMessage word(int ms, std::size_t grips) {
  BodyMessage message = test::ServoKit::first();
  message.time_step = 0.001;
  message.stamp_ns = ns(ms);
  message.rate = 1.0;
  message.bodies.tick = static_cast<std::uint64_t>(ms);
  message.bodies.time = 0.001 * ms;
  message.bodies.grips.resize(grips);
  return message;
}

void publish(Channel& channel, const BodyMessage& message) {
  channel.bodies().back() = message;
  channel.bodies().publish();
}

std::vector<PoseKey> a_way() {
  std::vector<PoseKey> keys(3);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i].time = 0.2 * static_cast<double>(i);
    keys[i].pose.position.x = 0.1 * static_cast<double>(i * i);
  }
  return keys;
}

std::unique_ptr<Device> script() {
  return std::make_unique<TrackDevice>(PoseTrack(a_way(), Pose{}), "script");
}

/// One that does in a single tick what none may.
class LapsingDevice final : public Device {
 public:
  explicit LapsingDevice(std::function<void()> lapse) : lapse_(std::move(lapse)) {}
  DeviceReport read(const DeviceMoment&) override {
    if (++reads_ == 50) lapse_();
    return {};
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  std::string kind() const override { return "lapsing"; }

 private:
  std::function<void()> lapse_;
  int reads_ = 0;
};

/// Each thing that is counted is found, once, in a hundred ticks.
TEST(NoAllocation, ALapseInOneTickIsFound) {
  static void* volatile kept = nullptr;
  static std::mutex mutex;
  struct Lapse {
    std::function<void()> act;
    std::size_t allocations, frees, locks;
  };
  for (const Lapse& lapse : {Lapse{[] {
                                     kept = new int(3);
                                     delete static_cast<int*>(kept);
                                   },
                                   1, 1, 0},
                             Lapse{[] {
                                     kept = std::malloc(8);
                                     std::free(kept);
                                   },
                                   1, 1, 0},
                             Lapse{[] {
                                     kept = std::calloc(1, 8);
                                     std::free(kept);
                                   },
                                   1, 1, 0},
                             Lapse{[] {
                                     kept = std::realloc(nullptr, 8);
                                     std::free(kept);
                                   },
                                   1, 1, 0},
                             Lapse{[] {
                                     kept = ::operator new(64, std::align_val_t(64));
                                     ::operator delete(kept, std::align_val_t(64));
                                   },
                                   1, 1, 0},
                             Lapse{[] {
                                     kept = strdup("said");
                                     std::free(kept);
                                   },
                                   1, 1, 0},
                             Lapse{[] { const std::lock_guard lock(mutex); }, 0, 0, 1}}) {
    test::ServoKit kit;
    ASSERT_TRUE(kit.servo->set_device(0, std::make_unique<LapsingDevice>(lapse.act)));
    const ThreadCalls calls = asked_for(*kit.servo, 100, [&](int i) { publish(kit.channel, word(i, 1)); });
    EXPECT_EQ(calls.allocations, lapse.allocations);
    EXPECT_EQ(calls.frees, lapse.frees);
    EXPECT_EQ(calls.locks, lapse.locks);
  }
}

/// All that the loop reads itself, and a hand whose device gives less than is asked of it.
TEST(NoAllocation, ATickOfEveryKindThatTheLoopReadsItself) {
  Scene scene = test::one_grip_scene();
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(script());
  devices.push_back(std::make_unique<MouseDevice>(std::make_shared<MouseTarget>(Pose{}), Pose{}));
  devices.push_back(std::make_unique<OperatorDevice>(PoseTrack(a_way(), Pose{}),
                                                     parse_operator("tight,tremor=0.0002").value()));
  auto lent = std::make_shared<SharedHandle>(Pose{});
  devices.push_back(std::make_unique<SharedHandleDevice>(script(), lent));
  auto weak = std::make_unique<test::FakeDevice>();
  weak->limit.max_force = 2.0;
  test::FakeDevice& arm = *weak;
  devices.push_back(std::move(weak));
  const std::size_t hands = devices.size();
  scene.grips.resize(hands, scene.grips[0]);
  BodyMessage first = test::ServoKit::first();
  first.bodies.grips.resize(hands);
  Channel channel(hands, first, 1 << 20);
  ServoOptions options;
  options.sample_interval = 0.001;
  options.sample_capacity = 16;  // nobody takes any: it fills up
  Servo servo(scene, std::move(devices), channel, options);

  expect_nothing(asked_for(servo, 1000, [&](int i) {
    publish(channel, word(i, hands));
    arm.next.pose.position.x = i > 50 ? 0.01 : 0.0;  // 10 N
    SharedHandle::Wish& wish = lent->wish.back();
    wish.taken = i > 200 && i < 500;
    wish.pose.position.y = 0.05;
    lent->wish.publish();
  }));
  EXPECT_GT(servo.samples_lost(), 0u);
  EXPECT_GT(servo.budget(4).clipped, 0.5) << "it clips";
  EXPECT_GT(arm.last_time, 0.9);
}

/// What does not happen in every tick: silence, a reset, a world that stands, another stiffness, a device let
/// go of.
TEST(NoAllocation, ATickInWhichTheWorldIsSilentIsResetOrStands) {
  DeviceLimits limits = limits_without_a_hand();
  limits.engagement_time = 0.1;
  limits.max_force_rate = 2000.0;
  test::ServoKit kit(limits);
  kit.device->next.pose.position.x = 0.005;
  double most = 0.0, least = 1e9;
  const ThreadCalls calls = asked_for(*kit.servo, 3000, [&](int i) {
    const double force =
        i > 2400 ? 0.0 : glm::length(kit.device->last.force);  // it is there until it is let go of
    most = std::max(most, force);
    if (i > 1000 && i < 1500) least = std::min(least, force);
    if (i == 2000) kit.servo->set_stiffness(0, 0.5);
    if (i == 2500) (void)kit.servo->set_device(0, nullptr);
    if (i > 1000 && i < 1450) return;
    BodyMessage message = word(i, 1);
    message.run = i > 1700 ? 1 : 0;
    if (i > 2200 && i < 2300) message.rate = 0.0;
    publish(kit.channel, message);
  });
  expect_nothing(calls);
  EXPECT_GT(most, 4.9);
  EXPECT_EQ(least, 0.0);
}

/// A replica of a body in which fluid swings, over 100 ms, with the host's line of it; 1 kHz recorded.
TEST(NoAllocation, ATickOfAReplicaWithSwingingFluidThatIsRecordedAt1kHz) {
  test::SwingingHost host;
  auto made = std::make_unique<test::FakeDevice>();
  test::FakeDevice& arm = *made;
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::move(made));
  Channel channel(1, host.word(0), 1 << 20);
  ServoOptions options;
  options.sample_interval = 0.001;
  Servo servo(host.scene, std::move(devices), channel, options);
  // The same words, to look at what is made of them.
  HeldBodies held(host.scene, Coupling::kReplica);
  ThreadCalls held_calls;
  int samples = 0;
  const ThreadCalls calls = asked_for(servo, 5000, [&](int ms) {
    const bool fresh = ms % 2 == 0;
    const BodyMessage word = host.word(ms);
    if (fresh) {
      channel.newest().back() = channel.bodies().back() = word;
      channel.newest().publish();
      channel.bodies().publish();
    }
    arm.next = host.hand(ms);
    ServoSample sample;
    while (servo.samples().pop(sample)) samples += 1;
    const ThreadCalls begin = thread_calls();
    held.update(word, fresh, ns(ms));
    held.sent(0, word.bodies.grips[0].on_hand, {true, true, arm.next.pose, arm.next.twist, true}, 0.0, false);
    held.advance(ns(ms + 1), 1.0, 0.001);
    const ThreadCalls now = thread_calls() - begin;
    held_calls.allocations += now.allocations;
    held_calls.locks += now.locks;
  });
  expect_nothing(calls);
  expect_nothing(held_calls);
  EXPECT_EQ(held.share(0), 1.0) << "the replica is what the hand holds,";
  ASSERT_NE(held.held(0), nullptr);
  const SloshFinder& found = held.held(0)->slosh(0);
  EXPECT_GT(found.share(), 0.9) << "and what swings in it is followed";
  EXPECT_NEAR(found.mode().pace, test::SwingingHost::kPace, 0.1 * test::SwingingHost::kPace);
  EXPECT_GT(samples, 4900);
}

/// Counts what the device within asks for on its own thread, once it is going.
class CountedDevice final : public Device {
 public:
  struct Seen {
    std::atomic<std::size_t> reads{0};
    std::atomic<std::size_t> calls{0};
  };
  CountedDevice(std::unique_ptr<Device> within, std::shared_ptr<Seen> seen)
      : within_(std::move(within)), seen_(std::move(seen)) {}
  DeviceReport read(const DeviceMoment& moment) override {
    if (++seen_->reads == 100) begin_ = thread_calls();
    if (seen_->reads > 100) seen_->calls = (thread_calls() - begin_).all();
    return within_->read(moment);
  }
  void write(const Wrench& on_hand) override { within_->write(on_hand); }
  void close() override { within_->close(); }
  DeviceLimits limits() const override { return within_->limits(); }
  std::string kind() const override { return within_->kind(); }

 private:
  std::unique_ptr<Device> within_;
  std::shared_ptr<Seen> seen_;
  ThreadCalls begin_;
};

/// A plug-in has a thread of its own: neither that nor the loop asks for anything.
TEST(NoAllocation, ATickOfAPlugInOnEitherThread) {
  const test::OwnFolder folder;
  setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
  auto plugin = std::make_unique<PluginDevice>(SLOSH_EXAMPLE_PLUGIN, "", HandPlace{});
  const Result<bool> opened = open_device(*plugin);
  ASSERT_TRUE(opened) << opened.error().text();
  const auto seen = std::make_shared<CountedDevice::Seen>();
  test::ServoKit kit;
  ASSERT_TRUE(kit.servo->set_device(0, std::make_unique<CountedDevice>(std::move(plugin), seen)));
  ThreadCalls sum;
  int ticks = 0;
  while (seen->reads < 1000) {
    ticks += 1;
    BodyMessage message = word(ticks, 1);
    message.bodies.grips[0].pose.position.x = 0.01;
    publish(kit.channel, message);
    const ThreadCalls begin = thread_calls();
    kit.servo->tick(steady_now_ns());
    sum.allocations += (thread_calls() - begin).all();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(sum.allocations, 0u) << "in " << ticks << " ticks";
  EXPECT_EQ(seen->calls, 0u) << "in " << seen->reads << " turns of the device's thread";
  EXPECT_TRUE(kit.servo->failure(0).empty());
  kit.servo->close_devices();
}

}  // namespace
}  // namespace slosh
