// The SpaceMouse driver, unmodified, on nodes that umockdev makes.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "peer/devices/hardware.h"
#include "peer/devices/spacemouse_device.h"
#include "tests/peer/devices/mocked_spacemouse.h"
#include "tests/peer/devices/own_folder.h"
#include "tests/peer/servo_kit.h"

namespace slosh {
namespace {

using test::MockedMachine;
using test::MockedSpaceMouse;

constexpr std::uint16_t kNavigator = 0xc626;  // of Logitech: translation and rotation apart
constexpr std::uint16_t kCompact = 0xc635;
constexpr std::uint16_t kWireless = 0xc62f;  // both in one report

std::vector<std::uint8_t> axes(std::uint8_t number, const std::vector<int>& counts) {
  std::vector<std::uint8_t> report{number};
  for (const int c : counts) {
    report.push_back(static_cast<std::uint8_t>(c & 0xff));
    report.push_back(static_cast<std::uint8_t>((c >> 8) & 0xff));
  }
  return report;
}

class SpaceMouseHid : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(settings_ / "slosh" / "devices"); }
  void write_settings(const std::string& name, const std::string& text) {
    std::ofstream(settings_ / "slosh" / "devices" / name) << text;
  }
  /// Says it, and reads until the driver has it.
  static void say(MockedSpaceMouse& mouse, SpaceMouseDevice& device,
                  const std::vector<std::uint8_t>& report) {
    const SpaceMouseLive before = device.live();
    mouse.say(report);
    for (SpaceMouseLive now = before; now.reports + now.malformed == before.reports + before.malformed;) {
      device.read({0.0, 0.001});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      now = device.live();
    }
  }

  /// A millisecond a look: what a driver makes of time is the same on a machine that is busy.
  std::function<std::int64_t()> clock() {
    return [this] { return now_ns_ += 1'000'000; };
  }

  test::OwnFolder own_;
  const std::filesystem::path settings_ = own_.path();
  const test::SetVariable config_{"XDG_CONFIG_HOME", settings_};
  MockedMachine machine_;
  std::int64_t now_ns_ = 1'000'000'000;
};

TEST_F(SpaceMouseHid, ListsSixAxesAndNothingElse) {
  MockedSpaceMouse navigator(machine_, 0, kLogitechVendor, kNavigator, "");
  MockedSpaceMouse keypad(machine_, 1, k3DconnexionVendor, 0xc650, "K");
  MockedSpaceMouse compact(machine_, 2, k3DconnexionVendor, kCompact, "S2");
  const std::vector<FoundDevice> found = find_hardware();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "SpaceNavigator");
  EXPECT_EQ(found[0].spec, "spacemouse:/dev/hidraw0") << "without a number its path names it";
  EXPECT_EQ(found[1].name, "SpaceMouse Compact");
  EXPECT_EQ(found[1].spec, "spacemouse:S2");
  EXPECT_EQ(found[1].problem, "");
}

TEST_F(SpaceMouseHid, ReadsTranslationAndRotationApart) {
  MockedSpaceMouse mouse(machine_, 0, kLogitechVendor, kNavigator, "");
  SpaceMouseDevice device("", Pose{}, {1, 0, 0, 0}, clock());
  const Result<bool> opened = open_device(device);
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_EQ(mouse.receive(2), (std::vector<std::uint8_t>{4, 1})) << "its light goes on";
  say(mouse, device, axes(1, {350, -20, 3}));
  say(mouse, device, axes(2, {-350, 400, 0}));
  say(mouse, device, {3, 0x05});
  const SpaceMouseLive live = device.live();
  EXPECT_EQ(live.state.axes, (SpaceMouseAxes{350, -20, 3, -350, 350, 0}));
  EXPECT_EQ(live.state.buttons, 5u);
  EXPECT_EQ(device.read({0.0, 0.001}).buttons, 5u);
  EXPECT_EQ(live.state.battery, -1);
  device.close();
  EXPECT_EQ(mouse.receive(2), (std::vector<std::uint8_t>{4, 0})) << "its light goes off";
}

TEST_F(SpaceMouseHid, ReadsBothInOneReportAndTheBattery) {
  MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, kWireless, "W1");
  SpaceMouseDevice device("W1", Pose{}, {1, 0, 0, 0}, clock());
  ASSERT_TRUE(open_device(device));
  say(mouse, device, axes(1, {10, 20, 30, -10, -20, -30}));
  say(mouse, device, {0x17, 83});
  EXPECT_EQ(device.live().state.axes, (SpaceMouseAxes{10, 20, 30, -10, -20, -30}));
  EXPECT_EQ(device.live().state.battery, 83);
  EXPECT_NE(device.status().find("battery 83 %"), std::string::npos) << device.status();
}

TEST_F(SpaceMouseHid, PassesOverShortAndMalformedReports) {
  MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, kCompact, "C");
  SpaceMouseDevice device("", Pose{}, {1, 0, 0, 0}, clock());
  ASSERT_TRUE(open_device(device));
  say(mouse, device, axes(1, {100, 0, 0}));
  for (const std::vector<std::uint8_t>& bad : {std::vector<std::uint8_t>{1},
                                               {1, 9, 9, 9},
                                               {1, 9, 9, 9, 9, 9, 9, 9},
                                               {2, 7},
                                               {3},
                                               {0x17},
                                               {0x17, 200}})
    say(mouse, device, bad);
  say(mouse, device, std::vector<std::uint8_t>(64, 0xff));  // a number that nobody knows
  EXPECT_EQ(device.live().malformed, 7u);
  EXPECT_EQ(device.live().reports, 2u);
  EXPECT_EQ(device.live().state.axes, (SpaceMouseAxes{100, 0, 0, 0, 0, 0}));
  EXPECT_EQ(device.live().state.battery, -1);
  EXPECT_TRUE(is_sound(device.read({0.0, 0.001})));
}

TEST_F(SpaceMouseHid, TwoOfAKindAreTwoHands) {
  MockedSpaceMouse left(machine_, 0, k3DconnexionVendor, kCompact, "");
  MockedSpaceMouse right(machine_, 1, k3DconnexionVendor, kCompact, "");
  SpaceMouseDevice first("", Pose{}, {1, 0, 0, 0}, clock());
  SpaceMouseDevice second("", Pose{}, {1, 0, 0, 0}, clock());
  SpaceMouseDevice third("", Pose{}, {1, 0, 0, 0}, clock());
  ASSERT_TRUE(open_device(first));
  ASSERT_TRUE(open_device(second));
  const Result<bool> refused = open_device(third);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("in another hand"), std::string::npos) << refused.error().text();
  say(left, first, axes(1, {11, 0, 0}));
  say(right, second, axes(1, {22, 0, 0}));
  EXPECT_EQ(first.live().state.axes[0], 11);
  EXPECT_EQ(second.live().state.axes[0], 22);
  first.close();
  EXPECT_TRUE(open_device(third)) << "what is let go of can be taken";
}

/// The driver as it is, and what it is sent: a SpaceMouse would not feel it.
struct Sent {
  std::atomic<double> force{0.0};
};
class Watched final : public Device {
 public:
  Watched(std::unique_ptr<SpaceMouseDevice> device, std::shared_ptr<Sent> sent)
      : device_(std::move(device)), sent_(std::move(sent)) {}
  DeviceReport read(const DeviceMoment& moment) override { return device_->read(moment); }
  void write(const Wrench& on_hand) override { sent_->force = on_hand.force.x; }
  DeviceLimits limits() const override { return device_->limits(); }
  bool gives_way() const override { return false; }
  void close() override { device_->close(); }
  std::string kind() const override { return device_->kind(); }
  std::string trouble() const override { return device_->trouble(); }

 private:
  std::unique_ptr<SpaceMouseDevice> device_;
  std::shared_ptr<Sent> sent_;
};

TEST_F(SpaceMouseHid, UnpluggedInTheMiddleTheHandFadesToZeroAndComesBackWithIt) {
  auto mouse = std::make_unique<MockedSpaceMouse>(machine_, 0, k3DconnexionVendor, kCompact, "C7");
  auto made = std::make_unique<SpaceMouseDevice>("", Pose{}, glm::dquat(1, 0, 0, 0));
  SpaceMouseDevice* device = made.get();
  ASSERT_TRUE(open_device(*device));
  test::ServoKit kit;
  auto sent = std::make_shared<Sent>();
  ASSERT_TRUE(kit.servo->set_device(0, std::make_unique<Watched>(std::move(made), sent)));
  int states = 0;
  GripState grip;
  grip.on_hand.force.x = 5.0;  // all the time
  const auto tick = [&] {
    test::publish_ahead(kit.channel, ++states, {grip});
    kit.servo->tick(steady_now_ns());
    ServoSample sample;
    while (kit.servo->samples().pop(sample)) {
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  while (std::abs(sent->force - 5.0) > 0.05) tick();
  mouse->say(axes(1, {200, 0, 0}));
  while (device->live().reports == 0) tick();
  EXPECT_TRUE(kit.servo->failure(0).empty());

  mouse->unplug();
  while (device->live().there) tick();
  EXPECT_NE(kit.servo->failure(0).find("unplugged"), std::string::npos) << kit.servo->failure(0);
  EXPECT_TRUE(find_hardware().empty());
  while (sent->force > 0.0) tick();

  MockedSpaceMouse again(machine_, 3, k3DconnexionVendor, kCompact, "C7");
  while (!device->live().there) tick();
  EXPECT_EQ(again.receive(2), (std::vector<std::uint8_t>{4, 1}));
  EXPECT_TRUE(kit.servo->failure(0).empty());
  while (std::abs(sent->force - 5.0) > 0.05) tick();
  again.say(axes(1, {0, 0, 100}));
  while (device->live().state.axes[2] != 100) tick();
  kit.servo->close_devices();
}

TEST_F(SpaceMouseHid, WhatIsPluggedInLaterIsFoundAndAnotherOneIsNotTakenForIt) {
  SpaceMouseDevice device("", Pose{}, {1, 0, 0, 0}, clock());
  const Result<bool> none = open_device(device);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text().find("no SpaceMouse is there"), std::string::npos) << none.error().text();
  auto mouse = std::make_unique<MockedSpaceMouse>(machine_, 0, k3DconnexionVendor, kCompact, "A");
  ASSERT_TRUE(open_device(device));
  mouse->unplug();
  while (device.read({0.0, 0.001}).heard) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  MockedSpaceMouse stranger(machine_, 1, k3DconnexionVendor, kCompact, "B");
  const std::int64_t until = now_ns_ + to_nanoseconds(2.5 * SpaceMouseDevice::kLookAgain);
  while (now_ns_ < until) {
    EXPECT_FALSE(device.read({0.0, 0.001}).heard);
  }
  MockedSpaceMouse same(machine_, 2, k3DconnexionVendor, kCompact, "A");
  while (!device.read({0.0, 0.001}).heard) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(SpaceMouseHid, EachHasItsOwnFileAndItsMistakesAreNamedByLine) {
  MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, kCompact, "A/1");
  write_settings("spacemouse.conf", "mode = position\n");
  SpaceMouseDevice device("", Pose{}, {1, 0, 0, 0}, clock());
  ASSERT_TRUE(open_device(device));
  device.close();
  write_settings("spacemouse-A_1.conf", "# mine\nmode = rate\nspeed_m_s = fast\n");
  SpaceMouseDevice second("", Pose{}, {1, 0, 0, 0}, clock());
  const Result<bool> refused = open_device(second);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().where.find("spacemouse-A_1.conf:3"), std::string::npos) << refused.error().text();
  EXPECT_NE(refused.error().text().find("'fast'"), std::string::npos);
  EXPECT_NE(refused.error().mend.find("0 to 5"), std::string::npos) << refused.error().mend;
}

TEST_F(SpaceMouseHid, GoesByTheCameraAsItIsTurned) {
  MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, kCompact, "C");
  test::ServoKit kit;
  auto made = std::make_unique<SpaceMouseDevice>("", Pose{}, glm::dquat(1, 0, 0, 0));
  ASSERT_TRUE(open_device(*made));
  ASSERT_TRUE(kit.servo->set_device(0, std::move(made)));
  kit.servo->look_from(glm::angleAxis(glm::radians(90.0), glm::dvec3(0, 1, 0)));
  glm::dvec3 speed(0.0);
  while (glm::length(speed) < 0.01) {
    mouse.say(axes(1, {350, 0, 0}));
    kit.servo->tick(steady_now_ns());
    if (kit.channel.pose(0).update()) speed = kit.channel.pose(0).front().twist.linear;
    std::this_thread::sleep_for(std::chrono::milliseconds(8));
  }
  EXPECT_LT(speed.z, -0.009) << "to the right of a picture that is seen from the right";
  EXPECT_NEAR(speed.x, 0.0, 1e-9);
  kit.servo->close_devices();
}

TEST_F(SpaceMouseHid, ADeflectionThatIsNotSaidAgainEnds) {
  MockedSpaceMouse mouse(machine_, 0, k3DconnexionVendor, kWireless, "W");
  SpaceMouseDevice device("", Pose{}, {1, 0, 0, 0}, clock());
  ASSERT_TRUE(open_device(device));
  say(mouse, device, axes(1, {350, 0, 0, 0, 0, 0}));
  // Its battery died with the cap held aside.
  DeviceReport still = device.read({0.0, 0.001});
  EXPECT_GT(still.twist.linear.x, 0.0);
  for (int i = 0; i < 1000; ++i) still = device.read({0.0, 0.001});
  EXPECT_NEAR(still.twist.linear.x, 0.0, 1e-9);
  EXPECT_LT(still.pose.position.x, 0.25 * 0.3) << "it went on for a moment only";
  EXPECT_GT(still.pose.position.x, 0.0);
}

}  // namespace
}  // namespace slosh
