// Devices from their specifications, and what each reports.
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "peer/haptics/make_device.h"
#include "peer/haptics/script_device.h"

namespace slosh {
namespace {

Scene two_grips() {
  Scene scene;
  scene.bodies.resize(1);
  scene.bodies[0].pose.position = {0, 1, 0};
  scene.grips.resize(2);
  scene.grips[0].body = scene.grips[1].body = 0;
  scene.grips[0].pose.position.x = -0.1;
  scene.grips[1].pose.position.x = 0.1;
  scene.grips[0].hand_motion.resize(2);
  scene.grips[0].hand_motion[1].time = 2.0;
  scene.grips[0].hand_motion[1].pose.position.z = 1.0;
  return scene;
}

TEST(MakeDevices, ScriptsByDefault) {
  const Scene scene = two_grips();
  Result<DeviceSet> set = make_devices(scene, {}, false);
  ASSERT_TRUE(set) << set.error().text();
  ASSERT_EQ(set.value().devices.size(), 2u);
  EXPECT_NEAR(set.value().devices[0]->read({1.0, 0.001}).pose.position.z, 0.5, 1e-9);
  EXPECT_GT(set.value().devices[0]->read({1.0, 0.001}).twist.linear.z, 0.0);
  const Pose still = set.value().devices[1]->read({1.0, 0.001}).pose;
  EXPECT_NEAR(glm::distance(still.position, glm::dvec3(0.1, 1.0, 0.0)), 0.0, 1e-12)
      << "a grip without a motion is held where it starts";
}

TEST(MakeDevices, OneSpecServesAllAndOneEachIsKeptInOrder) {
  const Scene scene = two_grips();
  Result<DeviceSet> set = make_devices(scene, {"script", "mouse"}, true);
  ASSERT_TRUE(set) << set.error().text();
  EXPECT_EQ(set.value().devices[0]->kind(), "script");
  EXPECT_EQ(set.value().devices[1]->kind(), "mouse");
  EXPECT_EQ(set.value().mouse_targets[0], nullptr);
  EXPECT_NE(set.value().mouse_targets[1], nullptr);
  EXPECT_EQ(make_devices(scene, {"mouse"}, true).value().devices[1]->kind(), "mouse");
}

TEST(MakeDevices, RefusesWhatCannotBe) {
  const Scene scene = two_grips();
  for (const std::vector<std::string>& specs : {std::vector<std::string>{"joystick"},
                                                {"script", "script", "script"},
                                                {"mouse"},
                                                {"replay:/nowhere.csv"}}) {
    const Result<DeviceSet> set = make_devices(scene, specs, false);
    ASSERT_FALSE(set) << specs[0];
    EXPECT_FALSE(set.error().what.empty());
    EXPECT_FALSE(set.error().mend.empty());
  }
}

TEST(MakeDevices, ReplaysARecordedHand) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "device_poses.csv";
  std::ofstream(file) << kPosesHeader
                      << "\n0,0,0,0,0,1,0,0,0\n0,1,5,0,0,1,0,0,0\n1,0,2,0,0,1,0,0,0\n1,1,5,0,0,1,0,0,0\n";
  Result<DeviceSet> set = make_devices(two_grips(), {"replay:" + file.string()}, false);
  ASSERT_TRUE(set) << set.error().text();
  EXPECT_NEAR(set.value().devices[0]->read({0.5, 0.001}).pose.position.x, 1.0, 1e-9);
  EXPECT_NEAR(set.value().devices[1]->read({0.5, 0.001}).pose.position.x, 5.0, 1e-9);
}

TEST(MouseDevice, ReachesItsTargetSmoothlyWithoutOvershoot) {
  auto target = std::make_shared<MouseTarget>(Pose{});
  MouseDevice mouse(target, Pose{});
  target->back().position.x = 0.1;
  target->back().orientation = glm::angleAxis(0.5, glm::dvec3(0, 1, 0));
  target->publish();
  double last = 0.0;
  DeviceReport report;
  for (int i = 0; i < 400; ++i) {
    report = mouse.read({0.0, 0.001});
    EXPECT_TRUE(is_sound(report));
    EXPECT_GE(report.pose.position.x, last);
    EXPECT_LE(report.pose.position.x, 0.1 + 1e-9);
    EXPECT_LT(report.pose.position.x - last, 0.0025) << "no step a millisecond";
    last = report.pose.position.x;
  }
  EXPECT_NEAR(last, 0.1, 1e-4);
  EXPECT_NEAR(glm::angle(report.pose.orientation), 0.5, 1e-3);
}

TEST(DeviceReport, SoundnessNeedsFiniteNumbersAndARotation) {
  EXPECT_TRUE(is_sound(DeviceReport{}));
  DeviceReport report;
  report.twist.linear.y = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_sound(report));
  report = {};
  report.pose.orientation.w = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_sound(report));
  report = {};
  report.pose.orientation.w = 0.9;
  EXPECT_FALSE(is_sound(report));
}

/// What a spec says of the force is what the device that it makes says.
TEST(Devices, ASpecTellsWhetherTheHandIsMoved) {
  Scene scene;
  scene.grips.resize(1);
  for (const char* spec :
       {"script", "mouse", "spacemouse", "falcon:1", "plugin:" SLOSH_EXAMPLE_PLUGIN, "operator:tight"}) {
    const Result<HandDevice> hand = make_device(scene, 0, spec, Pose{}, true);
    ASSERT_TRUE(hand) << spec;
    EXPECT_EQ(is_felt(spec), hand.value().device->gives_way()) << spec;
  }
  EXPECT_FALSE(is_felt("nothing at all"));
  EXPECT_FALSE(make_device(scene, 0, "plugin:./lib.so", Pose{}, true)) << "there is no such library";
}

}  // namespace
}  // namespace slosh
