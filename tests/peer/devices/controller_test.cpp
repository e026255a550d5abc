// A headset's controller as a device, with a fake of the controller itself.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "peer/devices/controller_device.h"
#include "peer/haptics/make_device.h"

namespace slosh {
namespace {

class FakeHands final : public HeadsetHands {
 public:
  HandReading read(HandSide) override { return now; }
  void vibrate(HandSide side, double strength, double seconds) override {
    EXPECT_EQ(side, HandSide::kRight);
    if (strength > 0.0) {
      EXPECT_LE(strength, 1.0);
      EXPECT_GT(seconds, 0.0);
    }
    shaken.push_back(strength);
  }
  HandReading now;
  std::vector<double> shaken;
};

class ControllerTest : public ::testing::Test {
 protected:
  ControllerTest() {
    hands->now.tracked = true;
    hands->now.twist_known = true;
    hands->now.pose.position = {0.3, 1.0, -0.2};
  }
  DeviceReport read() {
    now_ns += 1'000'000;
    return device.read({});
  }
  void at(const glm::dvec3& place, float squeeze) {
    hands->now.pose.position = place;
    hands->now.squeeze = squeeze;
  }

  std::int64_t now_ns = 1'000'000'000;
  std::shared_ptr<FakeHands> hands = std::make_shared<FakeHands>();
  std::shared_ptr<HeadsetLink> link = std::make_shared<HeadsetLink>(hands);
  Pose start{{0.1, 0.2, 0.3}, {1, 0, 0, 0}};
  ControllerDevice device{link, HandSide::kRight, start, [this] { return now_ns; }};
};

TEST_F(ControllerTest, StaysUntilItTakesHoldAndFollowsWhileItHolds) {
  at({0.3, 1.0, -0.2}, 1.0f);
  EXPECT_EQ(read().pose.position, start.position) << "no room yet: nobody wears the headset";
  RoomInWorld room;
  room.turned = 0.5 * 3.14159265358979;  // the room's −z is the world's −x
  room.scale = 0.5;
  link->place(room);
  at({0.3, 1.0, -0.2}, 0.0f);
  EXPECT_EQ(read().pose.position, start.position);
  at({0.0, 1.0, 0.0}, 0.0f);
  EXPECT_EQ(read().pose.position, start.position) << "an open hand moves freely";
  at({0.0, 1.0, 0.0}, 1.0f);
  EXPECT_LT(glm::distance(read().pose.position, start.position), 1e-12) << "no jump where it closes";
  at({0.0, 1.0, -0.1}, 1.0f);
  hands->now.twist.linear = {0.0, 0.0, -1.0};
  const DeviceReport moved = read();
  EXPECT_LT(glm::distance(moved.pose.position, start.position + glm::dvec3(-0.05, 0.0, 0.0)), 1e-9);
  EXPECT_LT(glm::distance(moved.twist.linear, glm::dvec3(-0.5, 0.0, 0.0)), 1e-9);
  EXPECT_TRUE(moved.engaged);
  at({0.0, 1.0, -0.1}, 0.5f);
  hands->now.pose.position.z = -0.2;
  EXPECT_LT(glm::distance(read().pose.position, start.position + glm::dvec3(-0.1, 0.0, 0.0)), 1e-9)
      << "a grip that loosens a little still holds";
  at({0.0, 1.0, -0.2}, 0.2f);
  read();
  at({0.4, 1.0, 0.4}, 0.2f);
  const DeviceReport open = read();
  EXPECT_LT(glm::distance(open.pose.position, start.position + glm::dvec3(-0.1, 0.0, 0.0)), 1e-9);
  EXPECT_EQ(open.twist.linear, glm::dvec3(0.0));
  at({0.4, 1.0, 0.4}, 1.0f);
  EXPECT_LT(glm::distance(read().pose.position, open.pose.position), 1e-9);
}

TEST_F(ControllerTest, TurnsTheHandle) {
  link->place({});
  at({}, 1.0f);
  read();
  hands->now.pose.orientation = glm::angleAxis(0.4, glm::dvec3(0, 0, 1));
  const glm::dvec3 turned = rotation_between(start.orientation, read().pose.orientation);
  EXPECT_LT(glm::distance(turned, glm::dvec3(0, 0, 0.4)), 1e-9);
}

TEST_F(ControllerTest, OutOfSightItStaysAndSaysSo) {
  link->place({});
  at({0, 1, 0}, 1.0f);
  read();
  at({0, 1.1, 0}, 1.0f);
  const Pose held = read().pose;
  EXPECT_EQ(device.trouble(), "");
  hands->now.tracked = false;
  hands->now.pose.position = {9, 9, 9};
  const DeviceReport lost = read();
  EXPECT_EQ(lost.pose.position, held.position);
  EXPECT_EQ(lost.twist.linear, glm::dvec3(0.0));
  EXPECT_TRUE(lost.heard);
  EXPECT_NE(device.trouble().find("right controller is not seen"), std::string::npos);
  hands->now.tracked = true;
  at({0.5, 1.5, 0}, 1.0f);
  EXPECT_LT(glm::distance(read().pose.position, held.position), 1e-9) << "and goes on from there";
  EXPECT_EQ(device.trouble(), "");
}

TEST_F(ControllerTest, WithoutTheRuntimesVelocityItsOwnIsTaken) {
  link->place({});
  hands->now.twist_known = false;
  DeviceReport last;
  for (int i = 0; i < 30; ++i) {
    at({0.0, 1.0 + 0.0005 * i, 0.0}, 1.0f);
    last = read();
  }
  EXPECT_NEAR(last.twist.linear.y, 0.5, 1e-6);
}

TEST_F(ControllerTest, VibratesByTheChangeOfTheForce) {
  link->place({});
  at({}, 1.0f);
  const auto feel = [&](double newtons, int milliseconds) {
    hands->shaken.clear();
    for (int i = 0; i < milliseconds; ++i) {
      read();
      device.write({{0.0, -newtons, 0.0}, {}});
    }
    double most = 0.0;
    for (const double s : hands->shaken) most = std::max(most, s);
    return most;
  };
  EXPECT_EQ(feel(20.0, 300), 0.0) << "a weight that is held is no news";
  const double small = feel(22.0, 300);
  EXPECT_GT(small, 0.1);
  EXPECT_LT(small, 0.5);
  EXPECT_DOUBLE_EQ(feel(40.0, 300), 1.0);
  EXPECT_LT(hands->shaken.size(), 16u) << "every 20 ms at most";
  EXPECT_EQ(feel(40.2, 300), 0.0) << "what nobody would feel";
  at({}, 0.0f);
  EXPECT_EQ(feel(10.0, 100), 0.0) << "an open hand feels nothing";
}

TEST_F(ControllerTest, SettingsAreReadAndRefusedByLine) {
  const auto parse = [](const std::string& text) {
    return read_controller_settings(DeviceFile::parse(text, "xr.conf").value());
  };
  const auto read = parse("hold_with = trigger\nopen_hand = lets_go\nvibration = 0\n");
  ASSERT_TRUE(read);
  EXPECT_EQ(read.value().hold_with, ControllerSettings::HoldWith::kTrigger);
  EXPECT_TRUE(read.value().open_hand_lets_go);
  EXPECT_EQ(read.value().vibration, 0.0);
  const auto wrong = parse("\nhold_with = teeth\n");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().text().find("2"), std::string::npos) << wrong.error().text();
}

TEST(Controllers, NeedAHeadsetAndAHandleEach) {
  Scene scene;
  scene.bodies.resize(1);
  scene.grips.resize(2);
  scene.grips[0].body = scene.grips[1].body = 0;
  const auto none = make_devices(scene, {"xr-left", "xr-right"}, true);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text().find("--vr"), std::string::npos) << none.error().text();
  const auto link = std::make_shared<HeadsetLink>(std::make_shared<FakeHands>());
  EXPECT_TRUE(make_devices(scene, {"xr-left", "xr-right"}, true, link));
  const std::vector<std::vector<std::string>> doubled{{"xr-left"}, {"xr-left", "xr-left"}};
  for (const auto& specs : doubled) {
    const auto two = make_devices(scene, specs, true, link);
    ASSERT_FALSE(two);
    EXPECT_NE(two.error().text().find("two handles"), std::string::npos) << two.error().text();
  }
}

}  // namespace
}  // namespace slosh
