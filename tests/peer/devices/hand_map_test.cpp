// A device's frame and reach against the world's: motion, force, power, gains, the clutch.
#include "peer/devices/hand_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "peer/devices/velocity_window.h"

namespace slosh {
namespace {

HandPlace looking_from_the_right() {
  HandPlace place;
  place.start.position = {1.0, 2.0, 3.0};
  place.start.orientation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 1, 0)));
  place.camera = camera_axes({5.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  return place;
}

DeviceReport at(const glm::dvec3& position, std::uint32_t buttons = 0) {
  DeviceReport report;
  report.pose.position = position;
  report.buttons = buttons;
  return report;
}

TEST(CameraAxes, RightUpAndTowardsTheEye) {
  const glm::dquat axes = camera_axes({5.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  EXPECT_NEAR(glm::distance(axes * glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(axes * glm::dvec3(0, 1, 0), glm::dvec3(0, 1, 0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(axes * glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1)), 0.0, 1e-12);
  EXPECT_TRUE(std::isfinite(camera_axes({0, 5, 0}, {0, 0, 0}).w)) << "straight down too";
}

TEST(HandMap, BeginsAtItsStartAndMovesWithTheCamera) {
  HandMapSettings settings;
  settings.scale = 3.0;
  HandMap map(settings, looking_from_the_right());
  const DeviceReport first = map.to_world(at({0.02, 0.01, 0.05}));
  EXPECT_NEAR(glm::distance(first.pose.position, glm::dvec3(1, 2, 3)), 0.0, 1e-12);
  DeviceReport moved = at({0.03, 0.01, 0.05});
  moved.pose.orientation = glm::angleAxis(0.3, glm::dvec3(0, 0, 1));
  moved.twist = {{0.1, 0, 0}, {0, 0, 1.0}};
  const DeviceReport world = map.to_world(moved);
  EXPECT_NEAR(glm::distance(world.pose.position, glm::dvec3(1, 2, 3 - 0.03)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(world.twist.linear, glm::dvec3(0, 0, -0.3)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(world.twist.angular, glm::dvec3(1, 0, 0)), 0.0, 1e-12);
  const glm::dvec3 turn =
      rotation_between(looking_from_the_right().start.orientation, world.pose.orientation);
  EXPECT_NEAR(glm::distance(turn, glm::dvec3(0.3, 0, 0)), 0.0, 1e-12);
}

TEST(HandMap, ForceAndMotionStayOneAnothersAndGainsFollowBothScales) {
  HandMapSettings settings;
  settings.scale = 4.0;
  settings.force_scale = 0.5;
  HandMap map(settings, looking_from_the_right());
  map.to_world(at({}));
  const Wrench world{{1.0, -2.0, 3.0}, {0.1, 0.2, 0.3}};
  const Wrench device = map.to_device(world);
  DeviceReport moving = at({});
  moving.twist.linear = {0.3, 0.2, -0.1};
  const double at_device = glm::dot(device.force, moving.twist.linear);
  const double in_world = glm::dot(world.force, map.to_world(moving).twist.linear);
  EXPECT_NEAR(at_device, 0.5 / 4.0 * in_world, 1e-12);

  DeviceLimits sheet = limits_without_a_hand();
  sheet.max_stiffness = 1000.0;
  sheet.max_force = 8.0;
  sheet.workspace_radius = 0.04;
  const DeviceLimits limits = map.to_world(sheet);
  // A spring of the world of K: K·(scale·x)·force_scale at the device.
  EXPECT_NEAR(limits.max_stiffness * 4.0 * 0.5, 1000.0, 1e-9);
  EXPECT_NEAR(glm::length(map.to_device({glm::dvec3(limits.max_force, 0, 0), {}}).force), 8.0, 1e-12);
  EXPECT_NEAR(limits.workspace_radius, 0.32, 1e-12);
}

TEST(LowPass, TakesOutWhatIsAboveItAndEndsWithTheForce) {
  const double period = 1e-4;
  for (const double hz : {20.0, 200.0}) {
    LowPass filter(hz, period);
    double most = 0.0;
    for (int i = 1; i < 20000; ++i) {
      const double wave = std::sin(2.0 * 3.14159265358979 * hz * period * i);
      const Wrench out = filter.pass({{wave, 0.0, 0.0}, {0.0, 2.0 * wave, 0.0}});
      if (i > 10000) most = std::max(most, out.force.x);
      EXPECT_EQ(out.torque.y, 2.0 * out.force.x);
    }
    EXPECT_NEAR(most, std::sqrt(0.5), 0.05) << hz;
    for (int i = 0; i < 20000; ++i) filter.pass({{3.0, 0.0, 0.0}, {}});
    EXPECT_NEAR(filter.pass({{3.0, 0.0, 0.0}, {}}).force.x, 3.0, 1e-9) << "slow forces pass whole";
    EXPECT_EQ(filter.pass({}).force.x, 0.0) << "and an end is one at once";
  }
  LowPass off(0.0, 0.001);
  EXPECT_EQ(off.pass({{5.0, 0.0, 0.0}, {}}).force.x, 5.0);
  EXPECT_EQ(off.pass({{-5.0, 0.0, 0.0}, {}}).force.x, -5.0);
}

TEST(HandMap, TheClutchLetsTheDeviceGoBackWithoutTheHand) {
  HandMapSettings settings;
  settings.clutch_button = 2;
  HandMap map(settings, HandPlace{});
  map.to_world(at({0, 0, 0}));
  EXPECT_NEAR(map.to_world(at({0.04, 0, 0})).pose.position.x, 0.04, 1e-12);
  DeviceReport back = at({0.02, 0, 0}, 2);
  back.twist.linear.x = -1.0;
  map.to_world(at({0.04, 0, 0}, 2));
  const DeviceReport clutched = map.to_world(back);
  EXPECT_NEAR(clutched.pose.position.x, 0.04, 1e-12);
  EXPECT_EQ(clutched.twist.linear.x, 0.0);
  map.to_world(at({-0.04, 0, 0}, 2));
  EXPECT_NEAR(map.to_world(at({-0.04, 0, 0})).pose.position.x, 0.04, 1e-12) << "no leap when it engages";
  EXPECT_NEAR(map.to_world(at({0.04, 0, 0})).pose.position.x, 0.12, 1e-12);
}

TEST(HandMap, ACameraThatTurnsLeavesTheHandWhereItIs) {
  HandMap map(HandMapSettings{}, HandPlace{});
  map.to_world(at({0, 0, 0}));
  DeviceReport device = at({0.03, 0, 0});
  device.pose.orientation = glm::angleAxis(0.4, glm::dvec3(0, 0, 1));
  const Pose before = map.to_world(device).pose;
  map.look_from(glm::angleAxis(glm::radians(90.0), glm::dvec3(0, 1, 0)));
  const Pose after = map.to_world(device).pose;
  EXPECT_NEAR(glm::distance(before.position, after.position), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(rotation_between(before.orientation, after.orientation)), 0.0, 1e-12);
  device.pose.position.x += 0.01;
  EXPECT_NEAR(glm::distance(map.to_world(device).pose.position, before.position + glm::dvec3(0, 0, -0.01)),
              0.0, 1e-12)
      << "to the right of the picture, wherever that is now";
  HandMapSettings fixed;
  fixed.by_camera = false;
  HandMap world(fixed, HandPlace{});
  world.to_world(at({0, 0, 0}));
  world.look_from(glm::angleAxis(1.0, glm::dvec3(0, 1, 0)));
  EXPECT_NEAR(world.to_world(at({0.03, 0, 0})).pose.position.x, 0.03, 1e-12);
}

TEST(HandMap, ADeadmanButtonHoldsOnOnlyWhileItIsHeld) {
  HandMapSettings settings;
  settings.deadman_button = 1;
  HandMap map(settings, HandPlace{});
  EXPECT_FALSE(map.to_world(at({})).engaged);
  EXPECT_TRUE(map.to_world(at({}, 1)).engaged);
}

TEST(HandMap, AFileThatAsksForMoreThanTheDampingHoldsIsWarnedOf) {
  DeviceLimits sheet = limits_without_a_hand();
  sheet.max_stiffness = 3000.0;
  const ChosenGains usual = choose_gains(sheet, 1.0, 0.01, 0.001, {}, "falcon");
  EXPECT_TRUE(usual.warnings.empty());
  EXPECT_NEAR(usual.limits.max_stiffness, 950.0, 1e-9) << "0.95 · 2 · (b/2) / T";
  HandMapSettings settings;
  settings.stiffness = 2500.0;
  const ChosenGains asked = choose_gains(sheet, 1.0, 0.01, 0.001, settings, "falcon");
  ASSERT_EQ(asked.warnings.size(), 1u);
  for (const char* words : {"falcon", "stiffness", "2500", "950", "Colgate"})
    EXPECT_NE(asked.warnings[0].find(words), std::string::npos) << asked.warnings[0];
  EXPECT_EQ(asked.limits.max_stiffness, 2500.0);
  settings.stiffness = 500.0;
  EXPECT_TRUE(choose_gains(sheet, 1.0, 0.01, 0.001, settings, "falcon").warnings.empty());
}

TEST(VelocityWindow, IsTheMeanOfItsWindowAndNothingAfterAGap) {
  VelocityWindow window;
  Twist twist;
  for (int i = 0; i < 50; ++i) {
    // 0.1 m/s in encoder steps of 60 µm.
    Pose pose;
    pose.position.x = 60e-6 * std::floor(1e-4 * i / 60e-6);
    pose.orientation = glm::angleAxis(0.002 * i, glm::dvec3(0, 1, 0));
    twist = window.add(pose, to_nanoseconds(0.001 * i));
  }
  EXPECT_NEAR(twist.linear.x, 0.1, 60e-6 / VelocityWindow::kWindow);
  EXPECT_NEAR(twist.angular.y, 2.0, 1e-6);
  Pose far;
  far.position.x = 1.0;
  EXPECT_EQ(window.add(far, to_nanoseconds(0.5)).linear.x, 0.0);
}

/// For who records: the device's own place whatever the hand is taken to do, and what was made of the force.
TEST(HandMap, TellsWhatTheDeviceItselfHadAndWasGiven) {
  HandMapSettings settings;
  settings.scale = 3.0;
  settings.force_scale = 0.5;
  settings.clutch_button = 1;
  settings.by_camera = false;
  settings.low_pass_hz = 50.0;
  HandMap map(settings, HandPlace{});
  DeviceReport at_device;
  at_device.pose.position = {0.01, 0.0, 0.0};
  EXPECT_FALSE(map.to_world(at_device).rendered) << "nothing was written yet";
  at_device.buttons = 1;  // the clutch
  (void)map.to_world(at_device);
  at_device.pose.position = {0.02, 0.0, 0.0};
  const Wrench written = map.filtered({{2.0, 0.0, 0.0}, {}});
  const DeviceReport in_world = map.to_world(at_device);
  EXPECT_EQ(in_world.pose.position.x, 0.0) << "the hand stays";
  ASSERT_TRUE(in_world.at_device && in_world.rendered);
  EXPECT_EQ(in_world.at_device->position.x, 0.02);
  EXPECT_EQ(in_world.rendered->force.x, written.force.x);
  EXPECT_GT(written.force.x, 0.0);
  EXPECT_LT(written.force.x, 0.5 * 2.0) << "held back by its band";
}

}  // namespace
}  // namespace slosh
