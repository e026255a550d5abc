// What a device says it can hold, and that no scene and no driver goes beyond it.
#include <gtest/gtest.h>

#include <limits>

#include "peer/haptics/make_device.h"
#include "servo_kit.h"

namespace slosh {
namespace {

using test::kTick;
using test::ServoKit;

/// A Touch, by its data sheet.
DeviceLimits touch() {
  DeviceLimits l;
  l.max_force = 3.3;
  l.max_torque = 0.1;
  l.max_force_rate = 1000.0;
  l.max_torque_rate = 20.0;
  l.max_stiffness = 400.0;
  l.max_damping = 4.0;
  l.max_rotational_stiffness = 1.0;
  l.max_rotational_damping = 0.01;
  l.workspace_radius = 0.075;
  return l;
}

TEST(DeviceLimits, ANumberThatIsMissingOrNoneIsRefusedWithItsName) {
  EXPECT_TRUE(check_limits(touch(), "touch"));
  EXPECT_FALSE(check_limits(DeviceLimits{}, "forgetful")) << "a driver that says nothing gets nothing";
  struct Field {
    const char* name;
    double DeviceLimits::* value;
  };
  for (const Field& field :
       {Field{"max_force", &DeviceLimits::max_force}, Field{"max_torque", &DeviceLimits::max_torque},
        Field{"max_force_rate", &DeviceLimits::max_force_rate},
        Field{"max_torque_rate", &DeviceLimits::max_torque_rate},
        Field{"max_stiffness", &DeviceLimits::max_stiffness},
        Field{"max_damping", &DeviceLimits::max_damping},
        Field{"max_rotational_stiffness", &DeviceLimits::max_rotational_stiffness},
        Field{"max_rotational_damping", &DeviceLimits::max_rotational_damping},
        Field{"workspace_radius", &DeviceLimits::workspace_radius},
        Field{"max_force_jerk", &DeviceLimits::max_force_jerk},
        Field{"max_torque_jerk", &DeviceLimits::max_torque_jerk}}) {
    for (const double bad :
         {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      DeviceLimits l = touch();
      l.*field.value = bad;
      const Result<bool> checked = check_limits(l, "touch");
      ASSERT_FALSE(checked) << field.name << " = " << bad;
      EXPECT_NE(checked.error().text().find(field.name), std::string::npos) << checked.error().text();
      EXPECT_NE(checked.error().text().find("touch"), std::string::npos);
      EXPECT_FALSE(checked.error().mend.empty());
    }
  }
  DeviceLimits l = touch();
  l.workspace_center.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(check_limits(l, "touch"));
  for (const double bad : {-0.1, 61.0, std::numeric_limits<double>::quiet_NaN()}) {
    l = touch();
    l.engagement_time = bad;
    const Result<bool> checked = check_limits(l, "touch");
    ASSERT_FALSE(checked) << bad;
    EXPECT_NE(checked.error().text().find("engagement_time"), std::string::npos) << checked.error().text();
  }
}

TEST(DeviceLimits, AServoRefusesADeviceAtOnceAndKeepsWhatItHad) {
  ServoKit kit;
  auto bad = std::make_unique<test::FakeDevice>();
  bad->limit.max_force = std::numeric_limits<double>::infinity();
  const Result<bool> set = kit.servo->set_device(0, std::move(bad));
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().what.find("max_force"), std::string::npos);
  EXPECT_EQ(kit.servo->device(0), kit.device);

  DeviceLimits none;
  ServoKit without(none);
  EXPECT_FALSE(without.servo->holds(0)) << "handed over at the start it is left out";
}

TEST(DeviceLimits, AHostsStiffnessIsClampedToWhatTheDeviceHolds) {
  DeviceLimits limits = touch();
  limits.max_force = 1e6;  // the gains, and not the force limiter, are what holds here
  limits.max_torque = 1e6;
  limits.max_force_rate = limits.max_torque_rate = limits.max_force_jerk = limits.max_torque_jerk = 1e12;
  limits.engagement_time = 0.0;
  for (const bool turns : {false, true}) {
    Scene scene = test::one_grip_scene();
    scene.grips[0].stiffness = 1e6;  // the most that a scene may ask for
    scene.grips[0].damping = 1e4;
    scene.grips[0].rotational_stiffness = 1e4;
    scene.grips[0].rotational_damping = 1e3;
    Channel channel(1, ServoKit::first(), 1000);
    auto made = std::make_unique<test::FakeDevice>();
    test::FakeDevice& device = *made;
    device.limit = limits;
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::move(made));
    Servo servo(scene, std::move(devices), channel, {});
    servo.tick(0);
    device.next.pose.position.x = 0.01;
    device.next.twist.linear.y = 0.1;
    if (turns) device.next.pose.orientation = glm::angleAxis(0.1, glm::dvec3(0, 0, 1));
    device.next.twist.angular.x = 0.5;
    servo.tick(1'000'000);
    EXPECT_NEAR(device.last.force.x, -400.0 * 0.01, 1e-9) << "10 000 N by the scene";
    EXPECT_NEAR(device.last.force.y, -4.0 * 0.1, 1e-9);
    EXPECT_NEAR(device.last.torque.z, turns ? -1.0 * 0.1 : 0.0, 1e-9);
    EXPECT_NEAR(device.last.torque.x, -0.01 * 0.5, 1e-9);
  }
}

TEST(DeviceLimits, GainsThatAreNoneBecomeNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CouplingGains gains = within({nan, -5.0, std::numeric_limits<double>::infinity(), 0.001}, touch());
  EXPECT_EQ(gains.stiffness, 0.0);
  EXPECT_EQ(gains.damping, 0.0);
  EXPECT_EQ(gains.rotational_stiffness, 1.0);
  EXPECT_EQ(gains.rotational_damping, 0.001);
}

TEST(DeviceLimits, OutsideItsWorkspaceAHandIsAtTheEdge) {
  DeviceLimits limits = limits_without_a_hand();
  limits.workspace_center = {0.0, 0.0, 0.0};
  limits.workspace_radius = 0.02;
  ServoKit kit(limits);
  kit.publish(0.0);
  kit.tick(0.0);
  const auto force_at = [&](double x) {
    kit.device->next.pose.position.x = x;
    kit.device->next.twist.linear.x = x > 0.02 ? 1.0 : 0.0;
    kit.device->next.twist.linear.y = x > 0.02 ? 0.3 : 0.0;
    kit.publish(kTick);
    kit.tick(kTick);
    return kit.device->last.force;
  };
  EXPECT_NEAR(force_at(0.02).x, -20.0, 1e-9);
  EXPECT_NEAR(force_at(0.5).x, -20.0, 1e-9)
      << "no more than at the edge: no spring of 500 N, no damper outwards";
  EXPECT_NEAR(force_at(0.5).y, -20.0 * 0.3, 1e-9) << "along the edge it moves";
  ASSERT_TRUE(kit.channel.pose(0).update());
  EXPECT_NEAR(kit.channel.pose(0).front().pose.position.x, 0.02, 1e-12) << "the host sees it there too";
  EXPECT_NE(kit.servo->status() & kStatusForceLimited, 0u);
}

TEST(DeviceLimits, ScriptsAndMiceStateTheirsAndChangeNoScene) {
  Scene scene = test::one_grip_scene();
  for (const char* spec : {"script", "mouse"}) {
    Result<HandDevice> hand = make_device(scene, 0, spec, {}, true);
    ASSERT_TRUE(hand) << spec;
    const DeviceLimits limits = hand.value().device->limits();
    EXPECT_TRUE(check_limits(limits, spec));
    EXPECT_TRUE(hand.value().device->immediate());
    const CouplingGains most{1e6, 1e4, 1e4, 1e3};  // scenes/FIELDS.md
    const CouplingGains held = within(most, limits);
    EXPECT_EQ(held.stiffness, most.stiffness);
    EXPECT_EQ(held.damping, most.damping);
    EXPECT_EQ(held.rotational_stiffness, most.rotational_stiffness);
    EXPECT_EQ(held.rotational_damping, most.rotational_damping);
  }
}

}  // namespace
}  // namespace slosh
