// Bodies that are cut while the world runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/fluid_models.h"
#include "tests/support/contains.h"
#include "tests/support/kitchen.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

using testing::kCutDensity;
using testing::kCutSpacing;
using testing::Kitchen;
using testing::state_in;

const glm::dvec3 kHalf(0.125, 0.0625, 0.25);  // m, of the block

Kitchen tumbling_block(int pieces) {
  Kitchen kitchen;
  const int block =
      kitchen.add_butter(testing::box_mesh(-kHalf, kHalf), pieces, 0.0,
                         {{0.1, 0.2, -0.1}, glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)))});
  kitchen.scene.bodies[static_cast<std::size_t>(block)].twist = {{0.5, -0.3, 0.2}, {2.0, 3.0, -1.0}};
  return kitchen;
}

struct Momenta {
  double mass = 0.0;
  glm::dvec3 linear{0.0}, angular{0.0};  // about the origin
  double energy = 0.0;
};

Momenta momenta_in(const Kitchen& kitchen, const World& world) {
  Momenta sum;
  const BodySnapshot state = state_in(world);
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const BodyState& s = state.bodies[b];
    if (s.gone || kitchen.scene.bodies[b].motion != BodyMotion::kFree) continue;
    const SolidIntegrals solid = integrate(clipped(kitchen.solids[b], planes_of(state.cuts.get(), b)));
    const double mass = kCutDensity * solid.volume;
    EXPECT_LT(glm::distance(s.center_of_mass, transform_point(s.pose, solid.center)), 1e-12);
    const glm::dmat3 r = glm::mat3_cast(s.pose.orientation);
    const glm::dvec3 spin = r * (kCutDensity * solid.inertia * (glm::transpose(r) * s.twist.angular));
    sum.mass += mass;
    sum.linear += mass * s.twist.linear;
    sum.angular += spin + glm::cross(s.center_of_mass, mass * s.twist.linear);
    sum.energy +=
        0.5 * mass * glm::dot(s.twist.linear, s.twist.linear) + 0.5 * glm::dot(spin, s.twist.angular);
  }
  return sum;
}

void expect_kept(const Momenta& before, const Momenta& after) {
  constexpr double kRounding = 1e-12;
  EXPECT_NEAR(after.mass, before.mass, kRounding * before.mass);
  EXPECT_LT(glm::length(after.linear - before.linear), kRounding * glm::length(before.linear));
  EXPECT_LT(glm::length(after.angular - before.angular), kRounding * glm::length(before.angular));
  EXPECT_NEAR(after.energy, before.energy, kRounding * before.energy);
}

TEST(Cutting, KeepsMassMomentumAngularMomentumAndEnergy) {
  const Kitchen kitchen = tumbling_block(4);
  World world = kitchen.world();
  for (int i = 0; i < 50; ++i) world.step({});
  const Momenta whole = momenta_in(kitchen, world);
  const Result<std::size_t> first = world.cut(0, {{0.3, 0.1, 1.0}, 0.05});
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_EQ(first.value(), 1u);
  expect_kept(whole, momenta_in(kitchen, world));
  for (const std::size_t piece : {std::size_t{0}, first.value()}) {
    const Result<std::size_t> next = world.cut(piece, {{1.0, 0.2, 0.1}, 0.0});
    ASSERT_TRUE(next) << next.error().text();
    expect_kept(whole, momenta_in(kitchen, world));
  }
  EXPECT_EQ(std::ranges::count_if(state_in(world).bodies, [](const BodyState& s) { return !s.gone; }), 4);
}

TEST(Cutting, PartsGoOnAsTheWholeWouldWhileNothingTouchesThem) {
  Kitchen kitchen = tumbling_block(2);
  kitchen.scene.bodies[0].twist.angular = glm::dvec3(0.0);
  World cut = kitchen.world(), whole = kitchen.world();
  ASSERT_TRUE(cut.cut(0, {{0, 0, 1}, 0.0}));
  for (int i = 0; i < 100; ++i) cut.step({}), whole.step({});
  const BodySnapshot parts = state_in(cut), one = state_in(whole);
  for (const std::size_t b : {0u, 1u})
    EXPECT_LT(glm::distance(parts.bodies[b].pose.position, one.bodies[0].pose.position), 1e-9)
        << "their mesh frames are still one: faces that lie on each other do not push";
}

TEST(Cutting, IsRefusedInWords) {
  Kitchen kitchen = tumbling_block(2);
  kitchen.add("stone", glm::dvec3(-0.1), glm::dvec3(0.1), BodyMotion::kFree, {{1, 1, 1}, {1, 0, 0, 0}});
  World world = kitchen.world();
  const std::uint64_t before = world.hash();
  const auto says = [&](std::size_t body, const CutPlane& plane, const char* what) {
    const Result<std::size_t> cut = world.cut(body, plane);
    ASSERT_FALSE(cut) << what;
    EXPECT_TRUE(test::contains(cut.error().text(), what)) << cut.error().text();
  };
  says(2, {{0, 1, 0}, 0.0}, "cannot be cut");
  says(1, {{0, 1, 0}, 0.0}, "is not there");
  says(9, {{0, 1, 0}, 0.0}, "no such body");
  says(0, {{0, 0, 0}, 0.0}, "is none");
  says(0, {{0, 1, 0}, 0.5}, "missed by the plane");
  says(0, {{0, 1, 0}, kHalf.y - 0.5 * kCutSpacing}, "thinner than");
  EXPECT_EQ(world.hash(), before);
  EXPECT_FALSE(world.appear(1)) << "a piece comes by a cut only";
  ASSERT_TRUE(world.cut(0, {{0, 0, 2.0}, 0.1}));
  says(0, {{1, 0, 0}, 0.0}, "has all its 2 pieces in the world");
}

TEST(Cutting, ThePartWithTheGripKeepsTheBodysNumber) {
  for (const double side : {-1.0, 1.0}) {
    Kitchen kitchen = tumbling_block(2);
    kitchen.add_grip(0, {0.0, 0.0, 0.2 * side});
    World world = kitchen.world();
    const CutPlane plane{{0, 0, 1}, 0.15 * side};  // the grip is on the smaller part
    ASSERT_TRUE(world.cut(0, plane));
    EXPECT_LT(state_in(world).cuts->bodies[0].planes.front().distance({0.0, 0.0, 0.2 * side}), 0.0);
  }
  Kitchen kitchen = tumbling_block(2);
  kitchen.add_grip(0, {0.0, 0.0, 0.2});
  kitchen.add_grip(0, {0.0, 0.0, -0.2});
  World world = kitchen.world();
  EXPECT_FALSE(world.cut(0, {{0, 0, 1}, 0.0})) << "on both";
  EXPECT_TRUE(world.cut(0, {{1, 0, 0}, 0.06}));
}

TEST(Cutting, AJointHoldsThePartThatItIsOnWhereItDid) {
  const glm::dvec3 pivot(0.0, 0.0, 0.2);
  Kitchen kitchen;
  kitchen.scene.gravity = {0.0, -9.81, 0.0};
  kitchen.add_butter(testing::box_mesh(-kHalf, kHalf), 2);
  Joint hinge;
  hinge.name = "hinge";
  hinge.body = 0;
  hinge.pose = {pivot, glm::angleAxis(1.5707963267948966, glm::dvec3(0, 0, 1))};  // about x
  kitchen.scene.joints.push_back(hinge);
  World world = kitchen.world();
  const auto off = [&] {
    return glm::distance(transform_point(state_in(world).bodies[0].pose, pivot), pivot);
  };
  for (int i = 0; i < 200; ++i) world.step({});
  ASSERT_TRUE(world.cut(0, {{0.0, 0.3, 1.0}, 0.1}));
  EXPECT_LT(state_in(world).cuts->bodies[0].planes.front().distance(pivot), 0.0);
  const double before = state_in(world).joints[0].position;
  EXPECT_LT(off(), 1e-9);
  for (int i = 0; i < 300; ++i) {
    world.step({});
    EXPECT_LT(off(), 1e-9);
  }
  EXPECT_GT(std::abs(state_in(world).joints[0].position - before), 0.1) << "it swings on";
  EXPECT_LT(state_in(world).bodies[1].pose.position.y, -0.3) << "the other falls";
}

TEST(Cutting, PartsStandOnTheTableWhereTheWholeStood) {
  Kitchen kitchen;
  kitchen.scene.gravity = {0.0, -9.81, 0.0};
  kitchen.add_butter(testing::box_mesh(-kHalf, kHalf), 3, 0.0, {{0, kHalf.y, 0}, {1, 0, 0, 0}});
  kitchen.add("table", {-0.5, -0.25, -0.5}, {0.5, 0.0, 0.5}, BodyMotion::kFixed);
  World world = kitchen.world();
  for (int i = 0; i < 200; ++i) world.step({});
  ASSERT_TRUE(world.cut(0, {{0.1, 0.0, 1.0}, 0.0}));
  ASSERT_TRUE(world.cut(0, {{1.0, 0.0, 0.0}, 0.01}));
  for (int i = 0; i < 500; ++i) world.step({});
  const BodySnapshot state = state_in(world);
  for (const std::size_t b : {0u, 1u, 2u}) {
    ASSERT_FALSE(state.bodies[b].gone);
    EXPECT_LT(glm::distance(state.bodies[b].pose.position, glm::dvec3(0, kHalf.y, 0)), 1e-3) << b;
    EXPECT_LT(glm::length(state.bodies[b].twist.linear), 1e-3) << b;
  }
}

TEST(Cutting, ASavedWorldKnowsThePiecesAndItsStartIsWhole) {
  Kitchen kitchen = tumbling_block(3);
  kitchen.add("table", {-0.5, -0.25, -0.5}, {0.5, -0.1, 0.5}, BodyMotion::kFixed);
  kitchen.scene.gravity = {0.0, -9.81, 0.0};
  World world = kitchen.world(), other = kitchen.world();
  std::vector<std::uint8_t> start, cut;
  ASSERT_TRUE(world.save(start));
  for (int i = 0; i < 50; ++i) world.step({});
  const std::uint64_t whole = world.hash();
  ASSERT_TRUE(world.cut(0, {{0.1, 0.0, 1.0}, 0.0}));
  for (int i = 0; i < 50; ++i) world.step({});
  ASSERT_TRUE(world.save(cut));
  const Result<bool> restored = other.restore(cut);
  ASSERT_TRUE(restored) << restored.error().text();
  EXPECT_EQ(state_in(world).cuts->bodies[0].planes, state_in(other).cuts->bodies[0].planes);
  for (int i = 0; i < 300; ++i) world.step({}), other.step({});
  EXPECT_EQ(world.hash(), other.hash()) << "contacts of the pieces too";
  ASSERT_TRUE(world.restore(start));
  EXPECT_TRUE(planes_of(state_in(world).cuts.get(), 0).empty());
  for (int i = 0; i < 50; ++i) world.step({});
  EXPECT_EQ(world.hash(), whole);
}

TEST(Cutting, DamagedBytesAreRefusedOrRunAllTheSame) {
  const Kitchen kitchen = tumbling_block(3);
  World world = kitchen.world(), other = kitchen.world();
  ASSERT_TRUE(world.cut(0, {{0.1, 0.0, 1.0}, 0.0}));
  ASSERT_TRUE(world.cut(1, {{1.0, 0.0, 0.1}, 0.0}));
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(world.save(saved));
  std::mt19937 random(1);
  int taken = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> damaged = saved;
    damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    if (!other.restore(damaged)) continue;
    ++taken;
    other.step({});
    for (const BodyState& body : state_in(other).bodies) EXPECT_TRUE(std::isfinite(body.pose.position.x));
  }
  EXPECT_GT(taken, 20);
  EXPECT_LT(taken, 200);
}

TEST(Cutting, WhatComesAgainIsWhole) {
  const Kitchen kitchen = tumbling_block(2);
  World world = kitchen.world();
  const Momenta before = momenta_in(kitchen, world);
  ASSERT_TRUE(world.cut(0, {{0, 0, 1}, 0.0}));
  ASSERT_TRUE(world.take_away(0));
  ASSERT_TRUE(world.take_away(1));
  ASSERT_TRUE(world.appear(0));
  expect_kept(before, momenta_in(kitchen, world));
  EXPECT_TRUE(world.cut(0, {{0, 0, 1}, 0.0}));
}

// A block of 12 x 6 x 8 cm (body 1) in a tank that is full of water to 10 cm, and what it may become. Half of
// it is in the water.
testing::Tank with_block_afloat(int pieces, double viscosity = 0.05) {
  constexpr double kTankSpacing = 0.01;
  const glm::dvec3 half(0.06, 0.03, 0.04), middle(0.0, 0.09, 0.0);
  Kitchen kitchen;
  kitchen.add_butter(testing::box_mesh(-half, half), pieces, 0.0, {middle, {1, 0, 0, 0}});
  const Result<SampledScene> block = sample_scene(kitchen.scene, kTankSpacing);
  EXPECT_TRUE(block);
  testing::Tank tank = testing::make_tank({.inner = {0.2, 0.2, 0.2}, .fill = 0.1, .viscosity = viscosity});
  testing::clear_box(tank.sampled, glm::vec3(middle), glm::vec3(half + 0.5 * kTankSpacing));
  for (std::size_t b = 0; b < kitchen.scene.bodies.size(); ++b) {
    Body body = kitchen.scene.bodies[b];
    body.mesh = static_cast<int>(tank.scene.meshes.size());
    if (body.piece_of >= 0) body.piece_of = 1;
    tank.scene.bodies.push_back(body);
    tank.sampled.surfaces.push_back(block.value().surfaces[b]);
    tank.sampled.distance_fields.push_back(block.value().distance_fields[b]);
  }
  tank.scene.meshes.push_back(kitchen.scene.meshes.front());
  return tank;
}

TEST(Cutting, WhatFloatsFloatsOnInTwo) {
  constexpr double kG = 9.81;
  const testing::Tank tank = with_block_afloat(2);
  World world = testing::world_of(tank);
  const double weight = kG * tank.scene.bodies[1].mass.mass;
  const auto lift_over = [&](double seconds) {
    double sum = 0.0, start = world.time();
    while (world.time() < start + seconds) {
      world.step({});
      for (const std::size_t b : {1u, 2u}) sum += state_in(world).bodies[b].fluid.force.y;
    }
    return sum * world.plan().time_step / seconds;
  };
  lift_over(0.5);
  EXPECT_NEAR(lift_over(0.5), weight, 0.05 * weight);
  ASSERT_TRUE(world.cut(1, {{1.0, 0.0, 0.2}, 0.01}));
  lift_over(0.1);
  EXPECT_NEAR(lift_over(0.5), weight, 0.05 * weight);
  for (const std::size_t b : {1u, 2u}) EXPECT_GT(state_in(world).bodies[b].fluid.force.y, 0.2 * weight);
  EXPECT_EQ(world.take_status() & (kStatusNonFinite | kStatusBodyGone), 0u);
  EXPECT_EQ(world.diagnostics().retired, 0u);
}

// What a hand is told of the fluid is of the part that it holds. Without viscosity all that is found is for a
// turn what it is on a way of the body's own radius of gyration.
TEST(Cutting, TheModelOfAHeldPartsFluidIsOfThatPart) {
  testing::Tank tank = with_block_afloat(2, 0.0);
  testing::add_grip(tank, 1);
  World world = testing::world_of(tank);
  const std::vector<char> wanted{0, 1, 0};
  FluidModels models(tank.scene), anew(tank.scene);
  std::vector<FluidWrenchModel> model, fresh;
  HandleInput hand;
  hand.engaged = true;
  hand.pose = tank.scene.bodies[1].pose;
  const double height = hand.pose.position.y;
  const auto step = [&] {
    hand.pose.position.y = height - 0.02 + 0.002 * std::sin(100.0 * world.time());
    world.step(std::span(&hand, 1));
    models.after_step(world, state_in(world), wanted, model);
  };
  double square = 0.0;  // m², of that radius
  const auto look = [&] {
    const FluidWrenchModel& now = model.front();
    const double way = now.added_mass[0][0] - now.d_velocity[0][0];
    if (!(way > 0.0)) return;
    square = (now.added_mass[3][3] - now.d_velocity[3][3]) / way;
    const MassProperties mass = world.mass(1);
    const double own = (mass.inertia[0][0] + mass.inertia[1][1] + mass.inertia[2][2]) / (2.0 * mass.mass);
    EXPECT_NEAR(square, own, 1e-9 * own);
  };
  for (int i = 0; i < 100; ++i) step(), look();
  const double whole = square, mass = world.mass(1).mass;
  EXPECT_EQ(mass, tank.scene.bodies[1].mass.mass);
  ASSERT_TRUE(world.cut(1, {{1.0, 0.0, 0.0}, 0.02}));
  EXPECT_NEAR(world.mass(1).mass, 8.0 / 12.0 * mass, 1e-6 * mass) << "the grip is in the larger part";
  for (int i = 0; i < 100; ++i) {
    step(), look();
    anew.after_step(world, state_in(world), wanted, fresh);
    EXPECT_EQ(model.front().wrench.force, fresh.front().wrench.force);
    EXPECT_EQ(model.front().d_velocity, fresh.front().d_velocity);
    EXPECT_EQ(model.front().added_mass, fresh.front().added_mass);
  }
  EXPECT_LT(square, 0.9 * whole);
}

}  // namespace
}  // namespace slosh
