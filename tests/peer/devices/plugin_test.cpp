// Plug-ins that work, real libraries.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "peer/haptics/device_loop.h"
#include "peer/devices/plugin_device.h"
#include "plugin_kit.h"
#include "tests/peer/servo_kit.h"

namespace slosh {
namespace {

using test::plugin;
using test::Plugins;
using test::ServoKit;

TEST_F(Plugins, TheExampleGivesWayToAForceAndComesBack) {
  auto device = plugin("slosh_example_device", "100");
  const Result<bool> opened = open_device(*device);
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_TRUE(device->gives_way());
  EXPECT_FALSE(device->immediate());
  const auto settle = [&](const glm::dvec3& force, double wanted) {
    for (double off = 1.0; off > 1e-4;) {
      const DeviceReport report = device->read({0.0, 0.001});
      ASSERT_TRUE(is_sound(report));
      device->write({force, glm::dvec3(0.0)});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      off = std::abs(report.pose.position.x - wanted);
    }
  };
  settle({2.0, 0.0, 0.0}, 0.02);  // 2 N on 100 N/m
  settle({0.0, 0.0, 0.0}, 0.0);
  device->close();
}

// By its file, as a user would.
TEST_F(Plugins, ABandForTheForceIsKeptTo) {
  std::filesystem::create_directories(folder_.path() / "slosh" / "devices");
  std::ofstream(folder_.path() / "slosh" / "devices" / "example.conf") << "low_pass_hz = 1\n";
  auto device = plugin("slosh_example_device", "100");
  ASSERT_TRUE(open_device(*device));
  // By 10 writes 1 ms apart of 2 N a pole at 1 Hz has let 6 % through: it gives way by that of 20 mm at most.
  double furthest = 0.0;
  for (int i = 0; i < 10; ++i) {
    furthest = std::max(furthest, device->read({0.0, 0.001}).pose.position.x);
    device->write({{2.0, 0.0, 0.0}, glm::dvec3(0.0)});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LT(furthest, 0.0013);
  for (int i = 0; i < 2000; ++i) device->write({{2.0, 0.0, 0.0}, glm::dvec3(0.0)});
  for (double off = 1.0; off > 1e-4;) {
    device->write({{2.0, 0.0, 0.0}, glm::dvec3(0.0)});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    off = std::abs(device->read({0.0, 0.001}).pose.position.x - 0.02);
  }
  device->close();
}

TEST_F(Plugins, OneOfTheFirstVersionIsTakenAsItIs) {
  auto device = plugin("slosh_plugin_version_one");
  const Result<bool> opened = open_device(*device);
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_TRUE(device->read({0.0, 0.001}).heard);
  device->close();
}

// A device that measures force, a hand of 500 N/m on it that wants it 20 mm to the right, a coupling of 1000
// N/m to a body that stands: it rests a third of the way, and the hand feels 6.67 N.
TEST_F(Plugins, AHandOnADeviceThatMeasuresForceIsWhereBothSpringsHaveIt) {
  const Scene scene = test::one_grip_scene();
  BodyMessage first = ServoKit::first();
  Channel channel(1, first, 1000);
  std::vector<std::unique_ptr<Device>> devices;
  auto made = plugin("slosh_admittance_device", "500,0.02");
  const Result<bool> opened = open_device(*made);
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_TRUE(made->warnings().empty()) << made->warnings()[0];
  EXPECT_NEAR(made->limits().max_stiffness, 0.95 * 6.0 / 0.001, 1e-6) << "by its virtual damping";
  devices.push_back(std::move(made));
  Servo servo(scene, std::move(devices), channel, ServoOptions{});
  DeviceLoop loop(servo);
  loop.start();
  ServoSample last{};
  double time = 0.0, most = 0.0;
  const auto goes_on = [&] {
    time += 0.001;
    BodyMessage& message = channel.bodies().back();
    message = ServoKit::first();
    message.rate = 1.0;
    message.bodies.time = time;
    message.bodies.tick = static_cast<std::uint64_t>(1e3 * time);
    message.stamp_ns = steady_now_ns() + to_nanoseconds(10.0);
    channel.bodies().publish();
    ServoSample sample;
    while (servo.samples().pop(sample)) {
      last = sample;
      most = std::max(most, glm::length(sample.on_hand.force));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  while (std::abs(last.on_hand.force.x + 20.0 / 3.0) > 0.02 ||
         std::abs(last.handle.position.x - 0.02 / 3.0) > 2e-5)
    goes_on();
  EXPECT_LT(most, 20.0) << "no more than the hand could pull";
  loop.stop();
  servo.close_devices();
  EXPECT_TRUE(servo.failure(0).empty()) << servo.failure(0);
}

TEST_F(Plugins, WhoStandsInForTheWorldsForceMovesADeviceThatMeasuresForce) {
  // 100 N/m, nowhere to go: 2 N hold it 20 mm away; none, and the hand has it back.
  auto device = plugin("slosh_admittance_device", "100,0");
  ASSERT_TRUE(open_device(*device));
  const auto settle = [&](double force, double wanted) {
    for (double off = 1.0; off > 1e-4;) {
      const DeviceReport report = device->read({0.0, 0.001});
      ASSERT_TRUE(is_sound(report));
      device->write({{force, 0.0, 0.0}, glm::dvec3(0.0)});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      off = std::abs(report.pose.position.x - wanted);
    }
  };
  settle(2.0, 0.02);
  settle(0.0, 0.0);
  // Told to rest in the middle of its way it stays, whatever its hand pulls.
  for (int i = 0; i < 200; ++i) {
    device->read({0.0, 0.001});
    device->write({{2.0, 0.0, 0.0}, glm::dvec3(0.0)});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  device->rest();
  const DeviceReport still = device->read({0.0, 0.001});
  EXPECT_EQ(still.twist.linear, glm::dvec3(0.0));
  device->close();
}

// A light handle and little damping, by its file: both are warned of, with the stiffest hand that it bears.
TEST_F(Plugins, AskingADeviceThatMeasuresForceForMoreIsWarnedOf) {
  std::filesystem::create_directories(folder_.path() / "slosh" / "devices");
  std::ofstream(folder_.path() / "slosh" / "devices" / "admittance.conf")
      << "virtual_mass_kg = 0.5\nown_damping_n_s_m = 2\n";
  auto device = plugin("slosh_admittance_device");
  ASSERT_TRUE(open_device(*device));
  ASSERT_EQ(device->warnings().size(), 2u);
  EXPECT_NE(device->warnings()[0].find("lighter handle"), std::string::npos);
  EXPECT_NE(device->warnings()[1].find("stiffer than 400 N/m"), std::string::npos) << device->warnings()[1];
  device->close();
}

TEST_F(Plugins, TheExampleRefusesAnOptionInItsOwnWords) {
  auto device = plugin("slosh_example_device", "stiff");
  const Result<bool> opened = open_device(*device);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().text().find("'stiff' is no stiffness"), std::string::npos)
      << opened.error().text();
}

}  // namespace
}  // namespace slosh
