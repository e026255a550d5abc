// Devices that do not answer, or throw: what the other hands feel, and what is written when they come back.
#include "peer/haptics/device_port.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "other_hand.h"
#include "peer/haptics/device_loop.h"
#include "peer/app/hand_trouble.h"

namespace slosh {
namespace {

using test::kForce;
using test::kOff;
using test::OtherDevice;
using test::OtherHand;
using test::ServoKit;

constexpr int kOnTheGrip = 300;  // readings for which it is there, so that it takes hold

/// What the test and a device's thread share.
struct Gate {
  std::mutex mutex;
  std::condition_variable changed;
  bool shut = false;     // read() waits
  bool waiting = false;  // and is waiting
  std::vector<double> written;
  int closed = 0;

  void set_shut(bool now) {
    const std::lock_guard lock(mutex);
    shut = now;
    changed.notify_all();
  }
  /// Generous: the machine may be busy.
  bool wait(const std::function<bool()>& done) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(60), done);
  }
};

/// Hardware: it waits for its next report, for ever when the gate is shut.
class WaitingDevice final : public Device {
 public:
  explicit WaitingDevice(std::shared_ptr<Gate> gate) : gate_(std::move(gate)) {}
  DeviceReport read(const DeviceMoment&) override {
    std::unique_lock lock(gate_->mutex);
    gate_->waiting = gate_->shut;
    gate_->changed.notify_all();
    gate_->changed.wait(lock, [this] { return !gate_->shut; });
    gate_->waiting = false;
    reads_ += 1;
    DeviceReport report;
    report.pose.position.x = reads_ > kOnTheGrip ? kOff : 0.0;
    return report;
  }
  void write(const Wrench& on_hand) override {
    const std::lock_guard lock(gate_->mutex);
    gate_->written.push_back(on_hand.force.x);
    gate_->changed.notify_all();
  }
  void close() override {
    const std::lock_guard lock(gate_->mutex);
    gate_->closed += 1;
    gate_->changed.notify_all();
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  std::string kind() const override { return "waiting"; }

 private:
  std::shared_ptr<Gate> gate_;
  int reads_ = 0;
};

/// Two hands on a running device loop.
struct TwoHands {
  Scene scene = test::one_grip_scene();
  std::unique_ptr<Channel> channel;
  std::shared_ptr<Gate> gate = std::make_shared<Gate>();
  std::shared_ptr<OtherHand> other = std::make_shared<OtherHand>();
  std::unique_ptr<Servo> servo;
  std::unique_ptr<DeviceLoop> loop;

  TwoHands() {
    channel = test::channel_of_two(scene);
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::make_unique<WaitingDevice>(gate));
    devices.push_back(std::make_unique<OtherDevice>(other, *channel, kOnTheGrip));
    servo = std::make_unique<Servo>(scene, std::move(devices), *channel, ServoOptions{});
    loop = std::make_unique<DeviceLoop>(*servo);
    loop->start();
  }
  ~TwoHands() { gate->set_shut(false); }
  bool full_force() {
    while (other->writes < 2 * kOnTheGrip) wait_for_loop(10);
    return gate->wait([this] { return !gate->written.empty() && gate->written.back() == kForce; });
  }
  void wait_for_loop(std::uint64_t ticks) {
    const std::uint64_t until = other->writes + ticks;
    while (other->writes < until) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
};

TEST(DevicePort, ADeviceThatDoesNotAnswerStopsNoOtherHandAndComesBackWithoutAForce) {
  TwoHands hands;
  ASSERT_TRUE(hands.full_force());
  hands.gate->set_shut(true);
  ASSERT_TRUE(hands.gate->wait([&] { return hands.gate->waiting; }));
  const std::int64_t blocked_ns = steady_now_ns();
  hands.other->least = 0.0;
  hands.other->most = -1e9;
  hands.wait_for_loop(1000);
  while (steady_now_ns() - blocked_ns < to_nanoseconds(kSilent + 0.1)) hands.wait_for_loop(10);
  EXPECT_EQ(hands.other->least, kForce) << "the other hand feels what is true,";
  EXPECT_EQ(hands.other->most, kForce) << "in every one of a thousand periods";
  std::size_t before = 0;
  {
    const std::lock_guard lock(hands.gate->mutex);
    before = hands.gate->written.size();
  }
  hands.gate->set_shut(false);
  ASSERT_TRUE(hands.gate->wait([&] { return hands.gate->written.size() > before; }));
  {
    const std::lock_guard lock(hands.gate->mutex);
    EXPECT_NEAR(hands.gate->written[before], 0.0, 0.2) << "what was wanted a second ago is not written";
  }
  ASSERT_TRUE(hands.full_force()) << "in the end it holds on again";
  {
    const std::lock_guard lock(hands.gate->mutex);
    double last = hands.gate->written[before];
    double steepest = 0.0;
    for (std::size_t i = before + 1; i < hands.gate->written.size(); ++i) {
      steepest = std::max(steepest, std::abs(hands.gate->written[i] - last));
      last = hands.gate->written[i];
    }
    EXPECT_LT(steepest, 5.0) << "and it came back without a blow";
  }
  hands.loop->stop();
  hands.servo->close_devices();
  EXPECT_EQ(hands.gate->written.back(), 0.0);
  EXPECT_EQ(hands.gate->closed, 1);
}

TEST(DevicePort, ADeviceThatNeverAnswersAgainHoldsUpNoEnd) {
  auto hands = std::make_unique<TwoHands>();
  const std::shared_ptr<Gate> gate = hands->gate;
  ASSERT_TRUE(hands->full_force());
  gate->set_shut(true);
  ASSERT_TRUE(gate->wait([&] { return gate->waiting; }));
  hands->loop->stop();  // returns, and so does everything below
  hands->servo->close_devices();
  hands->servo.reset();
  {
    const std::lock_guard lock(gate->mutex);
    EXPECT_EQ(gate->closed, 0) << "it is still being read";
  }
  gate->set_shut(false);
  ASSERT_TRUE(gate->wait([&] { return gate->closed == 1; })) << "whenever it comes back, it is let go of";
  EXPECT_EQ(gate->written.back(), 0.0);
}

TEST(DevicePort, AHandThatIsNotHeardIsNotSpokenFor) {
  TwoHands hands;
  ASSERT_TRUE(hands.full_force());
  hands.gate->set_shut(true);
  ASSERT_TRUE(hands.gate->wait([&] { return hands.gate->waiting; }));
  const std::int64_t blocked_ns = steady_now_ns();
  while (steady_now_ns() - blocked_ns < to_nanoseconds(2.0 * kHoldStale)) hands.wait_for_loop(10);
  hands.channel->pose(0).update();
  hands.channel->pose(1).update();
  hands.wait_for_loop(20);
  EXPECT_FALSE(hands.channel->pose(0).update())
      << "the host takes it for silent, and lets it in when it is back";
  EXPECT_TRUE(hands.channel->pose(1).update());
  hands.gate->set_shut(false);
  hands.loop->stop();
}

/// Throws from its third reading on, or its third writing.
class ThrowingDevice final : public Device {
 public:
  ThrowingDevice(bool on_write, bool immediate, std::shared_ptr<Gate> gate)
      : on_write_(on_write), immediate_(immediate), gate_(std::move(gate)) {}
  DeviceReport read(const DeviceMoment&) override {
    if (++reads_ > 2 && !on_write_) throw std::runtime_error("the cable is out");
    DeviceReport report;
    report.pose.position.x = reads_ > 1 ? kOff : 0.0;
    return report;
  }
  void write(const Wrench& on_hand) override {
    if (on_write_ && ++writes_ == 3) throw std::runtime_error("the cable is out");
    const std::lock_guard lock(gate_->mutex);
    gate_->written.push_back(on_hand.force.x);
    gate_->changed.notify_all();
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return immediate_; }
  std::string kind() const override { return "throwing"; }

 private:
  bool on_write_;
  bool immediate_;
  std::shared_ptr<Gate> gate_;
  int reads_ = 0;
  int writes_ = 0;
};

TEST(DevicePort, ADeviceThatThrowsIsSentZeroAndNamedAndTheLoopGoesOn) {
  for (const bool on_write : {false, true}) {
    for (const bool immediate : {false, true}) {
      ServoKit kit;
      auto gate = std::make_shared<Gate>();
      ASSERT_TRUE(kit.servo->set_device(0, std::make_unique<ThrowingDevice>(on_write, immediate, gate)));
      kit.servo->tick(steady_now_ns());
      while (kit.servo->failure(0).empty()) {
        kit.servo->tick(steady_now_ns());
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
      EXPECT_EQ(kit.servo->failure(0), "the cable is out");
      EXPECT_EQ(run_trouble("", *kit.servo, kit.scene), "the device in grip is out of use: the cable is out");
      EXPECT_EQ(run_troubles("the disk is full", *kit.servo, kit.scene).size(), 2u);
      ASSERT_TRUE(gate->wait([&] { return !gate->written.empty() && gate->written.back() == 0.0; }));
      const std::size_t written = gate->written.size();
      for (int i = 0; i < 5; ++i) kit.servo->tick(steady_now_ns());
      EXPECT_EQ(gate->written.size(), written) << "it is not asked again";
      kit.servo->close_devices();
    }
  }
}

/// Counts which of its readings each write answers: the loop's wrench says the reading that it had.
struct Turns {
  std::atomic<std::uint64_t> all{0};
  std::atomic<std::uint64_t> at_once{0};
};
class CountingDevice final : public Device {
 public:
  explicit CountingDevice(std::shared_ptr<Turns> turns) : turns_(std::move(turns)) {}
  DeviceReport read(const DeviceMoment&) override {
    reads_ += 1;
    return {};
  }
  void write(const Wrench& on_hand) override {
    turns_->all += 1;
    if (on_hand.force.x == static_cast<double>(reads_)) turns_->at_once += 1;
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  std::string kind() const override { return "counting"; }

 private:
  std::shared_ptr<Turns> turns_;
  std::uint64_t reads_ = 0;
};

/// A device that does not wait itself is written what the loop makes of the reading just before, and not of
/// the one before that. On a busy machine the loop here may miss many turns; where nobody waited for it, it
/// would all.
TEST(DevicePort, AReadingIsAnsweredByTheWriteThatFollows) {
  const auto turns = std::make_shared<Turns>();
  DevicePort port(std::make_unique<CountingDevice>(turns));
  while (turns->all < 1000) {
    const DeviceReading& reading = port.read({0.0, 0.001}, steady_now_ns());
    port.write({{static_cast<double>(reading.number), 0.0, 0.0}, {}});
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  port.stop();
  std::printf("%d of %d writes answer the reading just before\n", static_cast<int>(turns->at_once),
              static_cast<int>(turns->all));
  EXPECT_GT(turns->at_once, turns->all / 5);
}

}  // namespace
}  // namespace slosh
