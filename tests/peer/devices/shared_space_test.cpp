// A device and a headset in one space: the fit, what is refused, what is kept, how places are touched, and
// the hand after it.
#include "peer/devices/shared_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "peer/devices/device_file.h"
#include "peer/devices/hand_map.h"
#include "peer/devices/room_tie.h"
#include "tests/peer/devices/own_folder.h"

namespace slosh {
namespace {

const Pose kKnown{{0.4, 0.9, -0.6}, glm::normalize(glm::dquat(0.6, -0.3, 0.7, 0.2))};
const std::vector<glm::dvec3> kTips = {{0.05, 0.0, 0.02}, {-0.06, 0.01, 0.0}, {0.0, 0.08, -0.03}};

glm::dvec3 in_room(const glm::dvec3& tip) {
  return kKnown.position + kKnown.orientation * tip;
}
std::vector<TouchedPlace> touched(const std::vector<glm::dvec3>& tips = kTips) {
  std::vector<TouchedPlace> places;
  for (const glm::dvec3& tip : tips) places.push_back({tip, in_room(tip)});
  return places;
}
double apart(const glm::dquat& a, const glm::dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

TEST(SharedSpace, ThreePlacesGiveTheOffsetBack) {
  const Result<SharedSpace> fitted = fit_shared_space(touched());
  ASSERT_TRUE(fitted) << fitted.error().text();
  EXPECT_LT(glm::distance(fitted.value().device_in_room.position, kKnown.position), 1e-9);
  EXPECT_LT(apart(fitted.value().device_in_room.orientation, kKnown.orientation), 1e-7);
  EXPECT_LT(fitted.value().residual, 1e-9);
  // Also of more places, and turned by half a turn, where a naive formula divides by nothing.
  std::vector<glm::dvec3> more = kTips;
  more.push_back({0.03, -0.05, 0.06});
  EXPECT_LT(glm::distance(fit_shared_space(touched(more)).value().device_in_room.position, kKnown.position),
            1e-9);
  std::vector<TouchedPlace> turned;
  for (const glm::dvec3& tip : kTips) turned.push_back({tip, {-tip.x, tip.y, -tip.z}});
  EXPECT_LT(apart(fit_shared_space(turned).value().device_in_room.orientation, {0, 0, 1, 0}), 1e-7);
}

TEST(SharedSpace, AHandThatIsAMillimetreOffIsTakenAndSaysSo) {
  std::vector<TouchedPlace> places = touched();
  places[0].in_room.x += 0.002;
  places[1].in_room.y -= 0.002;
  const Result<SharedSpace> fitted = fit_shared_space(places);
  ASSERT_TRUE(fitted) << fitted.error().text();
  EXPECT_LT(glm::distance(fitted.value().device_in_room.position, kKnown.position), 0.004);
  EXPECT_GT(fitted.value().residual, 1e-5);
}

TEST(SharedSpace, WhatCannotBeRightIsRefusedInWords) {
  const auto said = [](const std::vector<TouchedPlace>& places) {
    const Result<SharedSpace> fitted = fit_shared_space(places);
    return fitted ? std::string("nothing") : fitted.error().text();
  };
  EXPECT_NE(said(touched({kTips[0], kTips[1]})).find("2 places were touched, three are needed"),
            std::string::npos);
  EXPECT_NE(said(touched({{0, 0, 0}, {0.05, 0.01, 0}, {0.1, 0.02, 0.0}})).find("on one line"),
            std::string::npos);
  EXPECT_NE(said(touched({{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}})).find("within 14 mm of each other"),
            std::string::npos);
  std::vector<TouchedPlace> off = touched();
  off[2].in_room += kKnown.orientation * glm::dvec3(0.0, 0.08, 0.0);
  EXPECT_NE(said(off).find("do not fit"), std::string::npos) << said(off);
  EXPECT_NE(said(off).find("the limit is 10 mm"), std::string::npos) << said(off);
  std::vector<TouchedPlace> none = touched();
  none[1].at_device.y = std::nan("");
  EXPECT_NE(said(none), "nothing");
}

TEST(SharedSpace, IsKeptByADevicesNameAndReadBack) {
  const test::OwnFolder folder;
  setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
  const auto file = shared_space_file("omega");
  EXPECT_EQ(file.filename(), "omega.room");
  ASSERT_TRUE(kept_shared_space(file));
  EXPECT_FALSE(kept_shared_space(file).value()) << "never calibrated";
  const SharedSpace space{kKnown, 0.0031};
  const Result<bool> kept = keep_shared_space(file, space);
  ASSERT_TRUE(kept) << kept.error().text();
  const auto back = kept_shared_space(file);
  ASSERT_TRUE(back) << back.error().text();
  ASSERT_TRUE(back.value());
  EXPECT_LT(glm::distance(back.value()->device_in_room.position, kKnown.position), 1e-6);
  EXPECT_LT(apart(back.value()->device_in_room.orientation, kKnown.orientation), 1e-6);
  EXPECT_NEAR(back.value()->residual, 0.0031, 1e-6);
  for (const char* wrong : {"x_m = far\n", "qw = 0.2\n", "x_m = 1\nx_m = 2\n", "colour = red\n"}) {
    std::ofstream(file) << wrong;
    const auto damaged = kept_shared_space(file);
    ASSERT_FALSE(damaged) << wrong;
    EXPECT_NE(damaged.error().where.find("omega.room"), std::string::npos) << damaged.error().text();
  }
}

class Touching : public ::testing::Test {
 protected:
  /// So many s at 100 Hz with the tip and the left controller there.
  TouchPlaces::Heard stay(const glm::dvec3& tip, double seconds, float squeeze) {
    TouchPlaces::Heard heard = TouchPlaces::Heard::kNothing;
    for (double passed = 0.0; passed < seconds; passed += 0.01) {
      time_ += 0.01;
      left_.tracked = true;
      left_.squeeze = squeeze;
      left_.pose.position = in_room(tip);
      const auto now = places_.follow(time_, tip, left_, right_);
      if (now != TouchPlaces::Heard::kNothing) heard = now;
    }
    return heard;
  }
  double time_ = 0.0;
  HandReading left_, right_;
  TouchPlaces places_;
};

TEST_F(Touching, AStillSqueezeTakesAPlaceOnce) {
  using Heard = TouchPlaces::Heard;
  EXPECT_EQ(stay(kTips[0], 0.5, 1.0f), Heard::kNothing) << "squeezed from the beginning";
  stay(kTips[0], 0.3, 0.0f);
  EXPECT_EQ(stay(kTips[0], 0.5, 1.0f), Heard::kTaken);
  EXPECT_EQ(places_.places().size(), 1u);
  stay(kTips[0], 0.3, 0.0f);
  EXPECT_EQ(stay(kTips[0] + glm::dvec3(0.01, 0, 0), 0.02, 1.0f), Heard::kMoved) << "it came there just now";
  stay(kTips[0] + glm::dvec3(0.01, 0, 0), 0.3, 0.0f);
  EXPECT_EQ(stay(kTips[0] + glm::dvec3(0.01, 0, 0), 0.3, 1.0f), Heard::kTooNear);
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
    stay(kTips[i], 0.3, 0.0f);
    EXPECT_EQ(stay(kTips[i], 0.3, 1.0f), Heard::kTaken);
  }
  EXPECT_TRUE(places_.complete());
  EXPECT_LT(
      glm::distance(fit_shared_space(places_.places()).value().device_in_room.position, kKnown.position),
      1e-9);
}

TEST_F(Touching, ASilentDeviceTakesNothing) {
  stay(kTips[0], 0.3, 0.0f);
  left_.squeeze = 1.0f;
  EXPECT_EQ(places_.follow(time_ + 0.01, std::nullopt, left_, right_), TouchPlaces::Heard::kMoved);
  EXPECT_TRUE(places_.places().empty());
}

class NoHands final : public HeadsetHands {
 public:
  HandReading read(HandSide) override { return {}; }
  void vibrate(HandSide, double, double) override {}
};

TEST(RoomTie, TheHandIsWhereTheTipIsSeen) {
  const test::OwnFolder folder;
  setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
  ASSERT_TRUE(keep_shared_space(shared_space_file("omega"), {kKnown, 0.0}));
  const double scale = 0.5;
  const auto link = std::make_shared<HeadsetLink>(std::make_shared<NoHands>(), scale);
  RoomTie tie(link);
  ASSERT_TRUE(tie.begin("omega"));
  ASSERT_TRUE(tie.shared());
  EXPECT_EQ(tie.name(), "omega");

  // As a device does it.
  HandMapSettings settings;
  settings.scale = 3.0;
  settings.by_camera = false;
  tie_to_room(settings, tie.scale());
  const Pose start{{0.1, 0.3, -0.2}, {1, 0, 0, 0}};
  HandMap map(settings, HandPlace{start, {}, {}});
  Pose hand;
  const auto read = [&](const glm::dvec3& tip) {
    DeviceReport report;
    report.pose.position = tip;
    const DeviceReport world = map.to_world(report);
    if (const auto axes = tie.follow(report.pose, world.pose)) map.look_from(*axes);
    hand = map.to_world(report).pose;
  };
  read(kTips[0]);
  ASSERT_TRUE(link->leading());
  EXPECT_LT(glm::distance(link->leading()->in_room, in_room(kTips[0])), 1e-6);
  EXPECT_EQ(link->leading()->in_world, start.position);
  // The room is placed as HeadsetView does it, any way round.
  RoomInWorld room;
  room.turned = 0.8;
  room.scale = scale;
  room.origin += link->leading()->in_world - room.to_world(Pose{link->leading()->in_room, {}}).position;
  link->place(room);
  read(kTips[0]);
  for (const glm::dvec3& tip : kTips) {
    read(tip);
    EXPECT_LT(glm::distance(hand.position, room.to_world(Pose{in_room(tip), {}}).position), 1e-5);
  }
  // A force in the world pushes the tip the same way in the room.
  const Wrench felt = map.to_device({{0.0, 2.0, 0.0}, glm::dvec3(0.0)});
  EXPECT_LT(glm::distance(kKnown.orientation * felt.force, glm::dvec3(0.0, 2.0, 0.0)), 1e-6);
  ASSERT_TRUE(tie.tip());
  EXPECT_EQ(tie.tip()->position, kTips[2]);
}

TEST(RoomTie, WithoutACalibrationNothingIsTied) {
  const test::OwnFolder folder;
  setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
  const auto link = std::make_shared<HeadsetLink>(std::make_shared<NoHands>());
  RoomTie tie(link);
  ASSERT_TRUE(tie.begin("omega"));
  EXPECT_FALSE(tie.shared());
  EXPECT_FALSE(tie.follow({}, {}));
  EXPECT_FALSE(link->leading());
  std::filesystem::create_directories(device_settings_folder());
  std::ofstream(shared_space_file("omega")) << "x_m = far\n";
  EXPECT_FALSE(tie.begin("omega"));
}

}  // namespace
}  // namespace slosh
