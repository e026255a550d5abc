// Guidance towards a recorded hand: how much, where to, and that it gives nothing that it has not taken.
#include "peer/haptics/guidance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace slosh {
namespace {

constexpr double kMaxGuiding = 3.0;     // N
constexpr double kTickOfGuide = 0.001;  // s
constexpr double kDeviceHolds = 100.0;  // N·s/m, of the device

std::vector<PoseKey> swinging(double seconds) {
  std::vector<PoseKey> keys;
  for (double t = 0.0; t <= seconds; t += 0.02)
    keys.push_back({t, {{0.1 * std::sin(3.0 * t), 0.05 * std::cos(2.0 * t), 0.0}, {1, 0, 0, 0}}});
  return keys;
}

/// A hand of half a kilogram in a person's arm, which pushes it about at random, beside the guidance.
struct Arm {
  glm::dvec3 place{0.1, 0.1, 0.05}, velocity{0.0}, push{0.0};
  std::mt19937 random{7};

  void move(double time, const glm::dvec3& force) {
    std::normal_distribution<double> normal;
    if (std::fmod(time, 0.1) < kTickOfGuide)
      push = 4.0 * glm::dvec3(normal(random), normal(random), normal(random));
    const glm::dvec3 arm = push - 30.0 * place - 3.0 * velocity;  // it keeps to its workspace
    velocity += kTickOfGuide / 0.5 * (arm + force);
    place += kTickOfGuide * velocity;
  }
};

TEST(Guidance, GivesNoMoreThanItTookAndKeepsToItsMost) {
  const std::vector<PoseKey> way = swinging(60.0);
  Guidance guide(way, kMaxGuiding);
  Arm arm;
  double least = 0.0, largest = 0.0;
  for (double time = 0.0; time < 60.0; time += kTickOfGuide) {
    const glm::dvec3 force = guide.force(time, arm.place, arm.velocity, kTickOfGuide, kDeviceHolds);
    largest = std::max(largest, glm::length(force));
    least = std::min(least, guide.taken());
    arm.move(time, force);
  }
  EXPECT_LE(largest, kMaxGuiding + 1e-12);
  EXPECT_GT(largest, 0.9 * kMaxGuiding) << "it did lead";
  EXPECT_GT(least, -1e-4) << "J: one tick's error of velocity";
  EXPECT_GT(guide.taken(), 0.05);
}

TEST(Guidance, BringsAHandNearerToTheWay) {
  const std::vector<PoseKey> way = swinging(60.0);
  double mean[2] = {};
  for (const bool led : {false, true}) {
    Guidance guide(way, kMaxGuiding);
    PoseTrack ghost(way, {});
    Arm arm;
    for (double time = 0.0; time < 60.0; time += kTickOfGuide) {
      const glm::dvec3 force = guide.force(time, arm.place, arm.velocity, kTickOfGuide, kDeviceHolds);
      arm.move(time, led ? force : glm::dvec3(0.0));
      mean[led] += glm::distance(ghost.at(time).pose.position, arm.place) * kTickOfGuide / 60.0;
    }
  }
  EXPECT_LT(mean[1], 0.8 * mean[0]) << mean[0] << " m without";
}

TEST(Guidance, DoesNotPushAHandThatRestsOrGoesAlong) {
  const std::vector<PoseKey> still{{0.0, {{0.2, 0.0, 0.0}, {1, 0, 0, 0}}}};
  Guidance guide(still, kMaxGuiding);
  EXPECT_EQ(guide.force(0.0, glm::dvec3(0.0), glm::dvec3(0.0), kTickOfGuide, kDeviceHolds), glm::dvec3(0.0));
  const glm::dvec3 along =
      guide.force(kTickOfGuide, {0.0001, 0.0, 0.0}, {0.1, 0.0, 0.0}, kTickOfGuide, kDeviceHolds);
  EXPECT_LT(glm::length(along), 1e-9);
  const glm::dvec3 astray =
      guide.force(2 * kTickOfGuide, {0.0001, 0.0001, 0.0}, {0.0, 0.1, 0.0}, kTickOfGuide, kDeviceHolds);
  EXPECT_NEAR(astray.y, -Guidance::kDamping * 0.1, 1e-2) << "what leads elsewhere is braked";
}

// Whatever the ghost does: one that leaps pulls no harder and gives no more.
TEST(Guidance, HoldsAgainstAGhostThatLeaps) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
  std::vector<PoseKey> way;
  for (double t = 0.0; t <= 20.0; t += 0.01)
    way.push_back({t, {{anywhere(random), anywhere(random), anywhere(random)}, {1, 0, 0, 0}}});
  Guidance guide(way, kMaxGuiding);
  Arm arm;
  double least = 0.0;
  for (double time = 0.0; time < 20.0; time += kTickOfGuide) {
    const glm::dvec3 force = guide.force(time, arm.place, arm.velocity, kTickOfGuide, kDeviceHolds);
    EXPECT_LE(glm::length(force), kMaxGuiding + 1e-12);
    least = std::min(least, guide.taken());
    arm.move(time, force);
  }
  EXPECT_GT(least, -1e-4);
}

TEST(GhostClock, AGhostDoesEachStepWithItsPersonAndWaitsForThem) {
  GhostClock clock({2.0, 5.0});
  EXPECT_EQ(clock.at(1.5), 1.5);
  EXPECT_EQ(clock.at(4.0), 2.0) << "it has done the first step, the person has not";
  clock.follow(1, 6.0);
  EXPECT_EQ(clock.at(6.0), 2.0);
  EXPECT_EQ(clock.at(7.0), 3.0);
  EXPECT_EQ(clock.at(100.0), 5.0);
  clock.follow(1, 8.0);
  EXPECT_EQ(clock.at(7.0), 3.0) << "no step was done since";
  clock.follow(2, 8.0);
  EXPECT_EQ(clock.at(9.0), 6.0) << "after its last step it goes on";
  clock.follow(0, 0.25);
  EXPECT_EQ(clock.at(1.25), 1.0) << "set back";
  EXPECT_EQ(GhostClock({}).at(3.0), 3.0) << "a run without a task goes by the world's time";
}

}  // namespace
}  // namespace slosh
