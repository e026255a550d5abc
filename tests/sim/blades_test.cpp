// A knife in a hand: what it feels on its way through a body, and what becomes of that.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/kitchen.h"

namespace slosh {
namespace {

using testing::kCutSpacing;
using testing::Kitchen;
using testing::state_in;

constexpr double kResistance = 100.0;         // N/m
constexpr double kStep = 1e-3;                // s
const glm::dvec3 kBlock(0.125, 0.125, 0.25);  // m, half of its width and depth, and its height
constexpr int kKnife = 1;                     // behind the table

// A table, a knife whose edge is `above` m over it, and a block on it that may be cut once.
Kitchen with_knife(const TriangleMesh& block, double above, double length = 0.4) {
  Kitchen kitchen;
  kitchen.add("table", {-0.5, -0.25, -0.5}, {0.5, 0.0, 0.5}, BodyMotion::kFixed);
  const double half = 0.5 * kCutSpacing;
  const int knife = kitchen.add("knife", {-0.5 * length, 0.0, -half}, {0.5 * length, 0.1, half},
                                BodyMotion::kFree, {{0, above, 0}, {1, 0, 0, 0}});
  kitchen.scene.bodies[static_cast<std::size_t>(knife)].blade = true;
  kitchen.add_grip(knife, {0.0, 0.1, 0.0});
  kitchen.add_butter(block, 2, kResistance);
  return kitchen;
}

TriangleMesh block_mesh() {
  return testing::box_mesh({-kBlock.x, 0.0, -kBlock.z}, {kBlock.x, kBlock.y, kBlock.z});
}

// A house whose walls end at half of the height; its ridge goes along z.
TriangleMesh house_mesh() {
  const double w = kBlock.x, h = kBlock.y;
  const glm::dvec2 outline[] = {{-w, 0.0}, {w, 0.0}, {w, 0.5 * h}, {0.0, h}, {-w, 0.5 * h}};
  TriangleMesh mesh;
  for (const double z : {-kBlock.z, kBlock.z})
    for (const glm::dvec2& p : outline) mesh.positions.emplace_back(p.x, p.y, z);
  mesh.normals.assign(10, glm::vec3(0, 1, 0));
  for (unsigned i = 1; i < 4; ++i) {
    mesh.triangles.emplace_back(0, i + 1, i);
    mesh.triangles.emplace_back(5, 5 + i, 5 + i + 1);
  }
  for (unsigned i = 0; i < 5; ++i) {
    const unsigned next = (i + 1) % 5;
    mesh.triangles.emplace_back(i, next, 5 + next);
    mesh.triangles.emplace_back(i, 5 + next, 5 + i);
  }
  return mesh;
}

/// What the hand feels while it goes by `speed` m/s for `seconds`: told of the edge's height and the force
/// up.
using Felt = std::function<void(double edge, double force)>;
void draw(World& world, double& hand, double speed, double seconds, const Felt& felt = {}) {
  for (double t = 0.0; t < seconds; t += kStep) {
    HandleInput input;
    input.engaged = true;
    input.pose.position = {0.0, hand, 0.0};
    input.twist.linear = {0.0, speed, 0.0};
    world.step(std::span(&input, 1));
    hand += speed * kStep;
    const BodySnapshot state = state_in(world);
    if (felt) felt(state.bodies[kKnife].pose.position.y, state.grips[0].on_hand.force.y);
  }
}

bool is_cut_through(const World& world) {
  return !state_in(world).bodies.back().gone;
}

TEST(Blades, ABlockResistsByItsWidthAllTheWayDown) {
  const Kitchen kitchen = with_knife(block_mesh(), kBlock.y + 0.01);
  World world = kitchen.world(kStep);
  double hand = kBlock.y + 0.01 + 0.1;
  int looks = 0;
  const double expected = kResistance * 2.0 * kBlock.x;
  draw(world, hand, -0.1, 1.1, [&](double edge, double force) {
    if (edge > kBlock.y - 0.01 || edge < 0.01) return;
    ++looks;
    EXPECT_NEAR(force, expected, 0.02 * expected) << edge;
  });
  EXPECT_GT(looks, 500);
}

TEST(Blades, ARoofResistsByItsWidthAtTheEdge) {
  const Kitchen kitchen = with_knife(house_mesh(), kBlock.y + 0.01);
  World world = kitchen.world(kStep);
  double hand = kBlock.y + 0.01 + 0.1;
  int in_roof = 0, below = 0;
  draw(world, hand, -0.05, 2.2, [&](double edge, double force) {
    const double depth = kBlock.y - edge, roof = 0.5 * kBlock.y;
    if (depth < 0.01 || edge < 0.01) return;
    ++(depth < roof ? in_roof : below);
    const double expected = kResistance * 2.0 * kBlock.x * std::min(depth / roof, 1.0);
    EXPECT_NEAR(force, expected, 0.05 * expected) << depth;
  });
  EXPECT_GT(in_roof, 500);
  EXPECT_GT(below, 300);
}

TEST(Blades, WhatIsCutThroughIsTwo) {
  const Kitchen kitchen = with_knife(block_mesh(), kBlock.y + 0.01);
  World world = kitchen.world(kStep);
  double hand = kBlock.y + 0.01 + 0.1;
  draw(world, hand, -0.1, 1.2);
  EXPECT_FALSE(is_cut_through(world));
  draw(world, hand, -0.1, 0.4);
  EXPECT_TRUE(is_cut_through(world));
  draw(world, hand, 0.1, 1.7);
  const BodySnapshot state = state_in(world);
  EXPECT_NEAR(state.grips[0].on_hand.force.y, 0.0, 0.5) << "it is out again";
  for (const std::size_t b : {2u, 3u}) {
    EXPECT_LT(glm::length(state.bodies[b].pose.position), 0.03) << "the knife is so thick";
    EXPECT_LT(glm::length(state.bodies[b].twist.linear), 0.05);
  }
}

TEST(Blades, AKnifeDrawnBackLeavesTheBodyWholeAndIsFreeOnItsWay) {
  const Kitchen kitchen = with_knife(block_mesh(), kBlock.y + 0.01);
  World world = kitchen.world(kStep);
  double hand = kBlock.y + 0.01 + 0.1;
  draw(world, hand, -0.1, 0.7);
  draw(world, hand, 0.1, 0.3);
  draw(world, hand, 0.1, 0.3, [](double, double force) { EXPECT_NEAR(force, 0.0, 0.5); });
  draw(world, hand, 0.1, 0.3);
  EXPECT_FALSE(is_cut_through(world));
  EXPECT_EQ(state_in(world).cuts, nullptr);
}

TEST(Blades, ItStandsBelowWhatItNeeds) {
  Kitchen kitchen = with_knife(block_mesh(), kBlock.y + 0.002);
  kitchen.scene.gravity = {0.0, -9.81, 0.0};
  World world = kitchen.world(kStep);
  for (int i = 0; i < 500; ++i) world.step({});
  EXPECT_NEAR(state_in(world).bodies[kKnife].pose.position.y, kBlock.y, 0.002) << "its weight is a quarter";
  EXPECT_FALSE(is_cut_through(world));
}

TEST(Blades, OneThatIsShorterThanTheBodySawsNothingOff) {
  const Kitchen kitchen = with_knife(block_mesh(), kBlock.y + 0.01, 0.15);
  World world = kitchen.world(kStep);
  double hand = kBlock.y + 0.01 + 0.1;
  draw(world, hand, -0.1, 1.7);
  EXPECT_FALSE(is_cut_through(world));
}

TEST(Blades, AFlatOneLiesOnTheBody) {
  Kitchen kitchen = with_knife(block_mesh(), 0.0);
  kitchen.scene.gravity = {0.0, -9.81, 0.0};
  kitchen.scene.bodies[kKnife].pose = {{0.0, kBlock.y + 0.5 * kCutSpacing + 0.001, 0.0},
                                       glm::angleAxis(0.5 * 3.14159265358979, glm::dvec3(1, 0, 0))};
  World world = kitchen.world(kStep);
  for (int i = 0; i < 500; ++i) world.step({});
  EXPECT_NEAR(state_in(world).bodies[kKnife].pose.position.y, kBlock.y + 0.5 * kCutSpacing, 1e-3);
}

TEST(Blades, ASavedWorldKnowsHowFarItCame) {
  const Kitchen kitchen = with_knife(block_mesh(), kBlock.y + 0.01);
  World world = kitchen.world(kStep), other = kitchen.world(kStep);
  double hand = kBlock.y + 0.01 + 0.1, same = 0.0;
  draw(world, hand, -0.1, 0.7);
  draw(world, hand, 0.1, 0.2);
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(world.save(saved));
  ASSERT_TRUE(other.restore(saved));
  same = hand;
  draw(world, hand, -0.1, 1.1);
  draw(other, same, -0.1, 1.1);
  EXPECT_EQ(world.hash(), other.hash());
  EXPECT_TRUE(is_cut_through(other));
}

// A knife and a block in free space, the knife thrown at it.
Kitchen thrown(double speed, double above) {
  Kitchen kitchen;
  const double half = 0.5 * kCutSpacing;
  kitchen.add("knife", {-0.2, 0.0, -half}, {0.2, 0.1, half}, BodyMotion::kFree,
              {{0, kBlock.y + above, 0}, {1, 0, 0, 0}});
  kitchen.scene.bodies[0].blade = true;
  kitchen.scene.bodies[0].twist.linear.y = -speed;
  kitchen.add_butter(block_mesh(), 2, kResistance);
  return kitchen;
}

struct Motion {
  double momentum = 0.0, energy = 0.0;
};
Motion motion_in(const Kitchen& kitchen, const World& world) {
  Motion sum;
  const BodySnapshot state = state_in(world);
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    if (state.bodies[b].gone) continue;
    const SolidIntegrals solid = integrate(clipped(kitchen.solids[b], planes_of(state.cuts.get(), b)));
    const double mass = testing::kCutDensity * solid.volume;
    const Twist& twist = state.bodies[b].twist;
    const glm::dvec3 turning = glm::conjugate(state.bodies[b].pose.orientation) * twist.angular;
    sum.momentum += mass * twist.linear.y;
    sum.energy += 0.5 * mass * glm::dot(twist.linear, twist.linear) +
                  0.5 * testing::kCutDensity * glm::dot(turning, solid.inertia * turning);
  }
  return sum;
}

// By energy: the force times the depth is what the two lose of the motion against each other.
TEST(Blades, OneThatIsThrownComesAsDeepAsItsEnergyTakesIt) {
  constexpr double kSpeed = 2.0;
  const Kitchen kitchen = thrown(kSpeed, 0.0201);
  World world = kitchen.world(kStep);
  const Motion before = motion_in(kitchen, world);
  double energy = before.energy;
  for (int i = 0; i < 200; ++i) {
    world.step({});
    const Motion now = motion_in(kitchen, world);
    EXPECT_NEAR(now.momentum, before.momentum, 1e-12);
    EXPECT_LE(now.energy, energy * (1.0 + 1e-12));
    energy = now.energy;
  }
  const double knife = kitchen.scene.bodies[0].mass.mass, block = kitchen.scene.bodies[1].mass.mass;
  const double reduced = knife * block / (knife + block);
  const double deep = 0.5 * reduced * kSpeed * kSpeed / (kResistance * 2.0 * kBlock.x);
  const BodySnapshot state = state_in(world);
  const double edge = state.bodies[0].pose.position.y - state.bodies[1].pose.position.y;
  EXPECT_NEAR(kBlock.y - edge, deep, 0.03 * deep);
  EXPECT_NEAR(state.bodies[0].twist.linear.y, state.bodies[1].twist.linear.y, 1e-7) << "it sticks there";
}

TEST(Blades, OneThatIsThrownHardComesOutOnTheOtherSide) {
  for (const double speed : {5.0, 20.0}) {
    const Kitchen kitchen = thrown(speed, 0.02);
    World world = kitchen.world(kStep);
    const Motion before = motion_in(kitchen, world);
    double energy = before.energy;
    for (int i = 0; i < 120; ++i) {
      world.step({});
      const Motion now = motion_in(kitchen, world);
      EXPECT_NEAR(now.momentum, before.momentum, 1e-10);
      EXPECT_LE(now.energy, energy * (1.0 + 1e-9));
      energy = now.energy;
    }
    EXPECT_TRUE(is_cut_through(world)) << speed;
    // The first and the last step of the way count as whole ones.
    const double force = kResistance * 2.0 * kBlock.x, work = force * kBlock.y;
    EXPECT_NEAR(before.energy - energy, work, 0.05 * work + 2.0 * force * speed * kStep) << speed;
  }
}

}  // namespace
}  // namespace slosh
