// Snapshots between two frames, on motions whose every moment is known.
#include "peer/remote/snapshot_history.h"

#include <gtest/gtest.h>

namespace slosh {
namespace {

constexpr std::size_t kHistoryCount = 100;

/// Particle i of the world at `time`: it moves evenly.
glm::vec3 truth(std::size_t i, double time) {
  const auto f = static_cast<double>(i);
  return glm::vec3(glm::dvec3(0.01 * f + 0.1 * time, 0.02 * f, -0.3 * time));
}

/// A frame of `epoch`, whose order is the world's rolled by the epoch's number.
DecodedFrame frame(std::uint64_t number, double time, std::uint32_t epoch, std::uint32_t run = 0) {
  DecodedFrame f;
  f.frame = number;
  f.time = time;
  f.epoch = epoch;
  f.run = run;
  f.complete = 1.0;
  for (std::size_t i = 0; i < kHistoryCount; ++i) {
    f.positions.push_back(truth((i + epoch * 7) % kHistoryCount, time));
    f.fluid_index.push_back(0);
  }
  return f;
}

BodySnapshot bodies(double time) {
  BodySnapshot s;
  s.time = time;
  s.bodies.resize(1);
  s.bodies[0].pose.position.x = 2.0 * time;
  s.bodies[0].pose.orientation = glm::angleAxis(0.8 * time, glm::normalize(glm::dvec3(1, 2, 3)));
  s.grips.resize(1);
  s.grips[0].on_hand.force.y = -4.0 * time;
  return s;
}

void expect_truth(const SnapshotPointer& snapshot, double time) {
  ASSERT_NE(snapshot, nullptr);
  ASSERT_EQ(snapshot->positions.size(), kHistoryCount);
  EXPECT_NEAR(snapshot->rigid.time, time, 1e-12);
  // Whatever the order, each particle of the world is there once.
  std::vector<bool> seen(kHistoryCount, false);
  for (const glm::vec3& p : snapshot->positions) {
    const auto i = static_cast<std::size_t>(p.y / 0.02f + 0.5f);
    ASSERT_LT(i, kHistoryCount);
    EXPECT_FALSE(seen[i]);
    seen[i] = true;
    EXPECT_LT(glm::distance(p, truth(i, time)), 1e-6f) << time;
  }
  EXPECT_NEAR(snapshot->rigid.bodies[0].pose.position.x, 2.0 * time, 1e-9);
  const glm::dquat turned = glm::angleAxis(0.8 * time, glm::normalize(glm::dvec3(1, 2, 3)));
  EXPECT_NEAR(glm::length(rotation_between(snapshot->rigid.bodies[0].pose.orientation, turned)), 0.0, 1e-9);
  EXPECT_NEAR(snapshot->rigid.grips[0].on_hand.force.y, -4.0 * time, 1e-9);
}

struct World {
  SnapshotHistory history;
  World() {
    // Two epochs: frame 3 begins the second, and comes in both orders.
    history.add(frame(1, 0.10, 1));
    history.add(frame(2, 0.15, 1));
    history.add(frame(3, 0.20, 1));
    history.add(frame(3, 0.20, 2));
    history.add(frame(4, 0.25, 2));
    for (int i = 0; i < 30; ++i) history.add(0, bodies(0.01 * i));
  }
};

TEST(SnapshotHistory, IsExactAtAndBetweenFramesAndAcrossEpochs) {
  const World world;
  for (double time = 0.10; time <= 0.2501; time += 0.01) {
    const std::optional<Between> between = world.history.at(time);
    ASSERT_TRUE(between);
    expect_truth(blend(*between), time);
  }
}

TEST(SnapshotHistory, TheOrderInWhichAnEpochsFirstFrameComesDoesNotMatter) {
  SnapshotHistory history;
  history.add(frame(1, 0.10, 1));
  history.add(frame(2, 0.20, 2));
  history.add(frame(2, 0.20, 1));
  history.add(frame(3, 0.30, 2));
  for (int i = 0; i < 40; ++i) history.add(0, bodies(0.01 * i));
  for (const double time : {0.10, 0.15, 0.20, 0.25, 0.30}) expect_truth(blend(*history.at(time)), time);
  history.forget_before(0.22);
  for (const double time : {0.22, 0.25, 0.30}) expect_truth(blend(*history.at(time)), time);
}

TEST(SnapshotHistory, HoldsTheLastFrameWhereNothingJoins) {
  SnapshotHistory history;
  history.add(frame(1, 0.10, 1));
  history.add(frame(9, 0.50, 2));  // the frames between were lost
  for (int i = 0; i < 60; ++i) history.add(0, bodies(0.01 * i));
  const SnapshotPointer snapshot = blend(*history.at(0.30));
  EXPECT_LT(glm::distance(snapshot->positions[0], truth(7, 0.10)), 1e-6f);
  EXPECT_NEAR(snapshot->rigid.bodies[0].pose.position.x, 0.6, 1e-9) << "bodies go on";
  expect_truth(blend(*history.at(0.50)), 0.50);
  EXPECT_LT(glm::distance(blend(*history.at(9.0))->positions[0], truth(14, 0.50)), 1e-6f);
  EXPECT_LT(glm::distance(blend(*history.at(0.0))->positions[0], truth(7, 0.10)), 1e-6f);
}

TEST(SnapshotHistory, WhatHasLeftTheWorldIsNotDrawn) {
  SnapshotHistory history;
  DecodedFrame gone = frame(2, 0.20, 1);
  gone.fluid_index[4] = 255;
  history.add(frame(1, 0.10, 1));
  history.add(std::move(gone));
  EXPECT_EQ(blend(*history.at(0.15))->fluid_index[4], 255);
  EXPECT_EQ(blend(*history.at(0.15))->fluid_index[5], 0);
}

TEST(SnapshotHistory, AResetForgetsWhatWas) {
  World world;
  world.history.add(frame(50, 0.0, 5, 1));
  EXPECT_EQ(world.history.run(), 1u);
  EXPECT_FALSE(world.history.has_bodies());
  world.history.add(frame(5, 0.30, 2, 0));
  EXPECT_DOUBLE_EQ(world.history.last_frame_time(), 0.0) << "a straggler of the run before";
  world.history.add(1, bodies(0.0));
  EXPECT_TRUE(world.history.has_bodies());
  world.history.restart();
  world.history.add(frame(1, 7.0, 1, 0));
  EXPECT_DOUBLE_EQ(world.history.first_frame_time(), 7.0) << "a new connection may bring any run";
}

TEST(SnapshotHistory, ForgetsNoMoreThanItMay) {
  World world;
  world.history.forget_before(0.17);
  for (const double time : {0.17, 0.20, 0.24}) expect_truth(blend(*world.history.at(time)), time);
  EXPECT_DOUBLE_EQ(world.history.first_frame_time(), 0.15);
}

TEST(SnapshotHistory, IsEmptyAtFirstAndShowsBodiesAlone) {
  SnapshotHistory history;
  EXPECT_FALSE(history.at(0.0));
  history.add(0, bodies(0.1));
  const SnapshotPointer snapshot = blend(*history.at(0.1));
  EXPECT_TRUE(snapshot->positions.empty());
  EXPECT_NEAR(snapshot->rigid.bodies[0].pose.position.x, 0.2, 1e-12);
}

Pose at(double x) {
  Pose pose;
  pose.position.x = x;
  return pose;
}

TEST(SnapshotHistory, OtherHandsAreWhereTheyAreThemselves) {
  SnapshotHistory history;
  history.add_hand(0, 0, 0.5, at(9.0), true);  // of no run yet
  for (int i = 0; i <= 20; ++i) history.add(0, bodies(0.05 * i));
  const auto hand_at = [&](double time) { return history.at(time)->rigid.grips[0].handle.position.x; };
  EXPECT_EQ(hand_at(0.5), 0.0) << "as the bodies have it";
  for (int i = 0; i <= 10; ++i) history.add_hand(0, 0, 0.1 * i, at(3.0 * 0.1 * i), true);
  EXPECT_NEAR(hand_at(0.55), 1.65, 1e-9) << "between two, evenly";
  EXPECT_NEAR(hand_at(1.1), 3.0, 1e-9) << "the last one for a moment";
  EXPECT_EQ(hand_at(1.5), 0.0) << "and not for ever";
  history.add_hand(0, 0, 1.1, at(7.0), false);
  EXPECT_NEAR(hand_at(1.05), 3.0, 1e-9);
  EXPECT_EQ(hand_at(1.15), 0.0) << "it has let go";
  history.add_hand(0, 0, 1.2, at(4.0), true);
  history.add_hand(0, 0, 1.2, at(5.0), true);
  EXPECT_NEAR(hand_at(1.25), 5.0, 1e-9) << "the world stands still, the hand does not";
  history.add_hand(0, 70, 1.2, at(5.0), true);
  history.add_hand(3, 0, 1.3, at(8.0), true);
  EXPECT_NEAR(hand_at(1.35), 5.0, 1e-9) << "of another run";
  history.forget_before(1.25);
  EXPECT_NEAR(hand_at(1.25), 5.0, 1e-9);
}

}  // namespace
}  // namespace slosh
