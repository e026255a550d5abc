// The gamepad driver, unmodified, on nodes that umockdev makes.
#include <gtest/gtest.h>
#include <linux/input.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <thread>

#include "peer/devices/gamepad_device.h"
#include "peer/devices/hardware.h"
#include "tests/peer/devices/mocked_gamepad.h"
#include "tests/peer/devices/own_folder.h"

namespace slosh {
namespace {

using test::MockedGamepad;
using test::MockedMachine;

class Gamepad : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(settings_ / "slosh" / "devices"); }
  /// A millisecond a look, so that a busy machine changes nothing.
  std::function<std::int64_t()> clock() {
    return [this] { return now_ns_ += 1'000'000; };
  }
  /// Reads until `there` holds.
  template <class There>
  DeviceReport read_until(GamepadDevice& device, There&& there) {
    DeviceReport report;
    for (int i = 0; i < 20000; ++i) {
      report = device.read({0.0, 0.001});
      if (there(report)) return report;
      if (i % 100 == 99) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "it never came";
    return report;
  }

  test::OwnFolder folder_;
  const std::filesystem::path settings_ = folder_.path() / "config";
  const test::SetVariable config_{"XDG_CONFIG_HOME", settings_};
  std::int64_t now_ns_ = 0;
};

TEST_F(Gamepad, IsFoundByWhatItIsAndListed) {
  MockedMachine machine;
  MockedGamepad pad(machine, 3, "Test Pad", "S1");
  const std::vector<GamepadFound> found = find_gamepads();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].path, "/dev/input/event3");
  EXPECT_EQ(found[0].name, "Test Pad");
  EXPECT_EQ(found[0].serial, "S1");
  const std::vector<FoundDevice> all = find_hardware();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].spec, "gamepad:S1");
  EXPECT_TRUE(all[0].problem.empty()) << all[0].problem;
}

TEST_F(Gamepad, ItsSticksAreAPlace) {
  MockedMachine machine;
  MockedGamepad pad(machine, 3, "Test Pad");
  Pose start;
  start.position = {1.0, 2.0, 3.0};
  GamepadDevice device("", start, {1.0, 0.0, 0.0, 0.0}, clock());
  const Result<bool> opened = device.open();
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_FALSE(device.gives_way());
  const double reach = gamepad_defaults().reach;
  pad.say(EV_ABS, ABS_X, 32767);
  DeviceReport report = read_until(device, [&](const DeviceReport& r) {
    return std::abs(r.pose.position.x - 1.0 - reach) < 1e-3 && glm::length(r.twist.linear) < 1e-3;
  });
  EXPECT_TRUE(report.heard);
  EXPECT_NEAR(report.pose.position.y, 2.0, 1e-9);
  pad.say(EV_ABS, ABS_X, 0);
  pad.say(EV_ABS, ABS_RZ, 255);    // up
  pad.say(EV_ABS, ABS_Y, -32768);  // into the picture
  report = read_until(device, [&](const DeviceReport& r) {
    return std::abs(r.pose.position.y - 2.0 - reach) < 1e-3 &&
           std::abs(r.pose.position.z - 3.0 + reach) < 1e-3;
  });
  EXPECT_NEAR(report.pose.position.x, 1.0, 2e-3);
  // A stick that is held still says nothing, and the hand stays.
  for (int i = 0; i < 2000; ++i) report = device.read({0.0, 0.001});
  EXPECT_NEAR(report.pose.position.y, 2.0 + reach, 1e-4);
  EXPECT_TRUE(report.heard);
  // What is within the dead zone is nothing.
  pad.say(EV_ABS, ABS_RZ, 0);
  pad.say(EV_ABS, ABS_Y, -2000);
  read_until(device,
             [&](const DeviceReport& r) { return glm::length(r.pose.position - start.position) < 1e-3; });
  EXPECT_NE(device.status().find("events"), std::string::npos);
}

TEST_F(Gamepad, TheClutchKeepsTheHandWhereItIsAndTheDeadmanHolds) {
  std::ofstream(settings_ / "slosh" / "devices" / "gamepad.conf") << "deadman_button = 5\nreach_m = 0.1\n";
  MockedMachine machine;
  MockedGamepad pad(machine, 3, "Test Pad");
  GamepadDevice device("", Pose{}, {1.0, 0.0, 0.0, 0.0}, clock());
  ASSERT_TRUE(device.open());
  EXPECT_FALSE(device.read({0.0, 0.001}).engaged);
  pad.say(EV_KEY, BTN_TL, 1);
  read_until(device, [](const DeviceReport& r) { return r.engaged; });
  pad.say(EV_KEY, BTN_SOUTH, 1);
  read_until(device, [](const DeviceReport& r) { return (r.buttons & 1u) != 0; });
  pad.say(EV_ABS, ABS_X, 32767);
  DeviceReport report;
  for (int i = 0; i < 1000; ++i) report = device.read({0.0, 0.001});
  EXPECT_NEAR(report.pose.position.x, 0.0, 1e-6);
}

TEST_F(Gamepad, UnpluggedItIsSilentAndGoesOnWhenItIsBack) {
  MockedMachine machine;
  auto pad = std::make_unique<MockedGamepad>(machine, 3, "Test Pad", "S1");
  GamepadDevice device("S1", Pose{}, {1.0, 0.0, 0.0, 0.0}, clock());
  ASSERT_TRUE(device.open());
  GamepadDevice second("", Pose{}, {1.0, 0.0, 0.0, 0.0}, clock());
  const Result<bool> taken = second.open();
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().what.find("another hand"), std::string::npos) << taken.error().text();
  pad->unplug();
  read_until(device, [](const DeviceReport& r) { return !r.heard; });
  EXPECT_NE(device.trouble().find("Test Pad"), std::string::npos);
  pad = std::make_unique<MockedGamepad>(machine, 4, "Test Pad", "S1");
  read_until(device, [](const DeviceReport& r) { return r.heard; });
  EXPECT_TRUE(device.trouble().empty());
}

TEST_F(Gamepad, WhatCannotBeIsSaidInWords) {
  MockedMachine machine;
  GamepadDevice none("", Pose{}, {1.0, 0.0, 0.0, 0.0}, clock());
  EXPECT_NE(none.open().error().what.find("no gamepad"), std::string::npos);
  std::ofstream(settings_ / "slosh" / "devices" / "gamepad.conf") << "reach_m = far\n";
  MockedGamepad pad(machine, 3, "Test Pad");
  GamepadDevice device("", Pose{}, {1.0, 0.0, 0.0, 0.0}, clock());
  const Result<bool> opened = device.open();
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().text().find("gamepad.conf"), std::string::npos) << opened.error().text();
}

}  // namespace
}  // namespace slosh
