#include "peer/haptics/pose_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace slosh {
namespace {

PoseKey key(double time, double x, double angle = 0.0) {
  PoseKey k;
  k.time = time;
  k.pose.position.x = x;
  k.pose.orientation = glm::angleAxis(angle, glm::dvec3(0, 0, 1));
  return k;
}

TEST(PoseTrack, GoesThroughItsKeysAndRestsOutside) {
  PoseTrack track({key(1, 0.0), key(2, 0.3, 0.5), key(4, 0.1, -0.2)}, Pose{});
  EXPECT_EQ(track.at(0.0).pose.position.x, 0.0);
  EXPECT_NEAR(track.at(2.0).pose.position.x, 0.3, 1e-12);
  EXPECT_NEAR(glm::angle(track.at(2.0).pose.orientation), 0.5, 1e-9);
  EXPECT_EQ(track.at(9.0).pose.position.x, 0.1);
  EXPECT_EQ(track.at(9.0).twist.linear.x, 0.0);
  EXPECT_EQ(track.at(0.5).twist.angular.z, 0.0);
  EXPECT_EQ(track.end(), 4.0);
}

TEST(PoseTrack, WithoutKeysItStandsAtItsRest) {
  Pose rest;
  rest.position.y = 2.0;
  PoseTrack track({}, rest);
  EXPECT_EQ(track.at(5.0).pose.position.y, 2.0);
  EXPECT_FALSE(track.moves());
}

TEST(PoseTrack, TheTwistIsTheDerivativeOfThePose) {
  PoseTrack track({key(0, 0.0), key(1, 0.3, 0.7), key(1.5, 0.35, 0.9), key(3, -0.1, -1.0)}, Pose{});
  constexpr double kH = 1e-6;
  for (double t = 0.05; t < 3.0; t += 0.0537) {
    const PoseTrack::Sample before = track.at(t - kH);
    const PoseTrack::Sample after = track.at(t + kH);
    const PoseTrack::Sample now = track.at(t);
    EXPECT_NEAR(now.twist.linear.x, (after.pose.position.x - before.pose.position.x) / (2 * kH), 1e-5) << t;
    const glm::dvec3 turn = rotation_between(before.pose.orientation, after.pose.orientation);
    EXPECT_NEAR(now.twist.angular.z, turn.z / (2 * kH), 1e-5) << t;
  }
}

TEST(PoseTrack, TheVelocityDoesNotJumpAtKeys) {
  PoseTrack track({key(0, 0.0), key(1, 0.2), key(2, 0.6), key(3, 0.7)}, Pose{});
  for (const double t : {0.0, 1.0, 2.0, 3.0}) {
    EXPECT_NEAR(track.at(t - 1e-7).twist.linear.x, track.at(t + 1e-7).twist.linear.x, 1e-4) << t;
  }
}

TEST(PoseTrack, ARestingHandRestsAndNothingOvershoots) {
  PoseTrack track({key(0, 0.0), key(1, 0.5), key(2, 0.5), key(3, 0.0)}, Pose{});
  for (double t = 1.0; t <= 2.0; t += 0.01) EXPECT_NEAR(track.at(t).pose.position.x, 0.5, 1e-12);
  for (double t = 0.0; t <= 3.0; t += 0.01) {
    EXPECT_GE(track.at(t).pose.position.x, -1e-12);
    EXPECT_LE(track.at(t).pose.position.x, 0.5 + 1e-12);
  }
}

TEST(PoseTrack, MayBeAskedInAnyOrder) {
  PoseTrack track({key(0, 0.0), key(1, 1.0), key(2, 3.0)}, Pose{});
  const double late = track.at(1.7).pose.position.x;
  const double early = track.at(0.3).pose.position.x;
  EXPECT_EQ(track.at(1.7).pose.position.x, late);
  EXPECT_EQ(track.at(0.3).pose.position.x, early);
  EXPECT_LT(early, late);
}

TEST(PoseTrack, TurnsTheShortWay) {
  const double almost = 0.9 * std::numbers::pi;
  PoseTrack track({key(0, 0, almost), key(1, 0, -almost)}, Pose{});
  // From +162° to −162° the short way leads over 180°.
  EXPECT_NEAR(std::abs(glm::angle(track.at(0.5).pose.orientation)), std::numbers::pi, 1e-6);
}

}  // namespace
}  // namespace slosh
