// A scripted hand that is taken with the mouse and given back.
#include "peer/haptics/shared_handle.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "peer/haptics/make_device.h"
#include "peer/haptics/script_device.h"

namespace slosh {
namespace {

constexpr double kLentTick = 0.001;

/// A script that goes 0.2 m/s along z for two seconds.
std::unique_ptr<Device> lent_script() {
  std::vector<PoseKey> keys(2);
  keys[1].time = 2.0;
  keys[1].pose.position.z = 0.4;
  return std::make_unique<TrackDevice>(PoseTrack(keys, Pose{}), "script");
}

struct Lent {
  std::shared_ptr<SharedHandle> hand = std::make_shared<SharedHandle>(Pose{});
  SharedHandleDevice device{lent_script(), hand};
  double time = 0.0;

  DeviceReport read(double elapsed = kLentTick) { return device.read({time += elapsed, kLentTick}); }
  void want(const glm::dvec3& place, bool taken = true) {
    hand->wish.back() = {taken, {place, {1.0, 0.0, 0.0, 0.0}}};
    hand->wish.publish();
  }
};

TEST(SharedHandleDevice, IsItsScriptToTheBitUntilSomebodyTakesIt) {
  Lent lent;
  const std::unique_ptr<Device> alone = lent_script();
  for (int i = 0; i < 1500; ++i) {
    const DeviceReport report = lent.read();
    const DeviceReport expected = alone->read({lent.time, kLentTick});
    ASSERT_EQ(report.pose.position, expected.pose.position);
    ASSERT_EQ(report.twist.linear, expected.twist.linear);
  }
  EXPECT_EQ(lent.device.kind(), "script");
}

TEST(SharedHandleDevice, GoesWhereItIsWantedWithoutAJumpAndNoFasterThanACarefulHand) {
  Lent lent;
  for (int i = 0; i < 500; ++i) lent.read();
  glm::dvec3 last = lent.read().pose.position;
  glm::dvec3 speed_before = lent.read().twist.linear;
  lent.want({1.0, 0.5, 0.0});
  double fastest = 0.0;
  double hardest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const DeviceReport report = lent.read();
    fastest = std::max(fastest, glm::length(report.twist.linear));
    hardest = std::max(hardest, glm::length(report.twist.linear - speed_before) / kLentTick);
    EXPECT_LT(glm::distance(report.pose.position, last), 1.3 * kLentTick + 3e-4);
    speed_before = report.twist.linear;
    last = report.pose.position;
  }
  EXPECT_LT(fastest, 1.25) << "m/s: it is drawn by 80 mm at most";
  EXPECT_GT(fastest, 0.9);
  EXPECT_LT(hardest, 80.0) << "m/s²: 30²/s² · 80 mm = 72, and what the script's own speed adds";
  EXPECT_NEAR(glm::distance(last, glm::dvec3(1.0, 0.5, 0.0)), 0.0, 1e-6);
}

TEST(SharedHandleDevice, ReportsTheVelocityThatItMovesWith) {
  Lent lent;
  lent.read();
  lent.want({0.05, 0.0, 0.0});
  double x = lent.read().pose.position.x;
  for (int i = 0; i < 200; ++i) {
    const DeviceReport report = lent.read();
    EXPECT_NEAR((report.pose.position.x - x) / kLentTick, report.twist.linear.x, 0.023)
        << "half a tick of 45 m/s²";
    x = report.pose.position.x;
  }
}

TEST(SharedHandleDevice, StandsInAWorldThatStandsAndIsSoundAfterALongGap) {
  Lent lent;
  lent.read();
  lent.want({0.05, 0.0, 0.0});
  const Pose before = lent.read(0.0).pose;
  EXPECT_EQ(lent.read(0.0).pose.position, before.position);
  EXPECT_NEAR(lent.read(5.0).pose.position.x, 0.05, 1e-9) << "any time at once, without overshooting";
}

TEST(SharedHandleDevice, GoesHomeToItsScriptWhenGivenBack) {
  Lent lent;
  lent.read();
  lent.want({0.5, 0.0, 0.0});
  for (int i = 0; i < 1000; ++i) lent.read();
  lent.want({}, false);
  const double begin = lent.time;
  Pose last = lent.read().pose;
  double fastest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Pose pose = lent.read().pose;
    fastest = std::max(fastest, glm::distance(pose.position, last.position) / kLentTick);
    last = pose;
  }
  EXPECT_LT(fastest, 0.65) << "m/s: half a metre in two seconds or more, and the script's 0.2";
  const DeviceReport home = lent.read();
  EXPECT_EQ(home.pose.position, lent_script()->read({lent.time, kLentTick}).pose.position);
  EXPECT_GT(lent.time, begin + 2.0);
}

TEST(SharedHandleDevice, IsItsScriptAgainWhenTheWorldBeginsAgain) {
  Lent lent;
  lent.read(1.0);
  lent.want({0.5, 0.0, 0.0});
  for (int i = 0; i < 500; ++i) lent.read();
  lent.want({}, false);
  lent.time = 0.0;
  EXPECT_EQ(lent.read().pose.position, lent_script()->read({kLentTick, kLentTick}).pose.position);
}

TEST(SharedHandleDevice, SaysWhereTheHandleIs) {
  Lent lent;
  const Pose pose = lent.read(0.5).pose;
  ASSERT_TRUE(lent.hand->now.update());
  EXPECT_EQ(lent.hand->now.front().position, pose.position);
}

TEST(MakeDevices, LendsScriptsToAWindowAndNothingElse) {
  Scene scene;
  scene.bodies.resize(1);
  scene.grips.resize(2);
  scene.grips[0].body = scene.grips[1].body = 0;
  Result<DeviceSet> set = make_devices(scene, {"script", "mouse"}, true);
  ASSERT_TRUE(set) << set.error().text();
  EXPECT_NE(set.value().lent[0], nullptr);
  EXPECT_EQ(set.value().lent[1], nullptr);
  EXPECT_EQ(make_devices(scene, {}, false).value().lent[0], nullptr) << "without a window nobody can take it";
}

}  // namespace
}  // namespace slosh
