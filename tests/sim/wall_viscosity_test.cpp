// A wall that has the fluid's viscosity, against walls that are given one.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/make/solid.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kSpacing = 0.01;   // m
constexpr double kViscosity = 2.0;  // Pa·s

/// Fluid that slides through a box at 0.1 m/s, without gravity; `upper` Pa·s is that of its upper half,
/// `lower` of the other. It reaches from wall to wall, or is `half_length` m to either side of the middle.
Scene sliding(double wall, double upper = kViscosity, double half_length = 0.06, double lower = kViscosity) {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, lower);
  b.add_fluid(1000.0, upper);
  b.add_fixed("tank", lab::tank_at_floor({0.12, 0.12, 0.12}, 0.03));
  b.add_volume(make::box({-half_length, 0.0, -0.06}, {half_length, 0.06, 0.06}), 0);
  b.add_volume(make::box({-half_length, 0.06, -0.06}, {half_length, 0.11, 0.06}), upper == lower ? 0 : 1);
  b.set_domain({-1.0, -0.5, -1.0}, {1.0, 1.0, 1.0});
  b.scene.gravity = glm::dvec3(0.0);
  b.scene.bodies[0].dynamic_viscosity = wall;
  for (FluidVolume& volume : b.scene.fluid_volumes) volume.velocity = {0.1, 0.0, 0.0};
  return b.scene;
}

struct Pulled {
  double shear = 0.0;     // N, along the flow on the walls in the first step
  double identity = 0.0;  // N: what the fluid lost less what the walls got
  double turning = 0.0;   // N·m, the same about the tank's centre of mass
  bool solved = false;    // drag was
  std::uint64_t hash = 0;
};

Pulled pull(const Scene& scene, bool implicit_viscosity = false) {
  const SampledScene sampled = sample_scene(scene, kSpacing).value();
  World world(scene, sampled, make_plan(scene, kSpacing, implicit_viscosity), WorldOptions{1, Backend::kCpu});
  BodySnapshot now;
  world.fill(now);
  const glm::dvec3 centre = transform_point(now.bodies[0].pose, scene.bodies[0].mass.center_of_mass);
  const double before = world.diagnostics().momentum.x;
  std::vector<glm::vec3> from, to;
  world.fill_velocities(from);
  world.step({});
  world.fill_velocities(to);
  world.fill(now);
  Pulled pulled;
  pulled.solved = world.plan().has(PassId::kImplicitViscosity);
  pulled.shear = now.bodies[0].fluid.force.x;
  pulled.identity = (world.diagnostics().momentum.x - before) / world.plan().time_step + pulled.shear;
  // A step's forces act where the particles were as it began.
  const double mass = 1000.0 * std::pow(kSpacing, 3);
  glm::dvec3 torque = now.bodies[0].fluid.torque;
  for (std::size_t i = 0; i < from.size(); ++i)
    torque += glm::cross(glm::dvec3(sampled.fluid_positions[i]) - centre,
                         mass / world.plan().time_step * glm::dvec3(to[i] - from[i]));
  pulled.turning = glm::length(torque);
  for (int i = 0; i < 20; ++i) world.step({});
  pulled.hash = world.hash();
  return pulled;
}

TEST(WallViscosity, OfTheFluidIsAsIfTheFluidsWereGiven) {
  const Pulled given = pull(sliding(kViscosity));
  const Pulled own = pull(sliding(kFluidsViscosity));
  EXPECT_EQ(own.shear, given.shear);
  EXPECT_EQ(own.hash, given.hash);
  EXPECT_EQ(make_plan(sliding(kFluidsViscosity), kSpacing).time_step,
            make_plan(sliding(kViscosity), kSpacing).time_step);
}

TEST(WallViscosity, AWallOfNoneHasHalfTheShear) {
  const double sticks = pull(sliding(kFluidsViscosity)).shear;
  const double none = pull(sliding(0.0)).shear;
  EXPECT_GT(sticks, 0.1);
  std::printf("shear %.3f N where it sticks, %.3f N where the wall's is 0\n", sticks, none);
  EXPECT_NEAR(none / sticks, 0.5, 0.05) << "Eq 9's mean of the fluid's viscosity and 0";
}

// What is left is pressure: the same whatever the fluid. Nothing stands in its way here: fluid and walls meet
// along the flow alone.
TEST(WallViscosity, AWallThatSlipsDragsNothing) {
  const double sticks = pull(sliding(kFluidsViscosity, kViscosity, 0.03)).shear;
  const Pulled one = pull(sliding(kFreeSlip, kViscosity, 0.03));
  const Pulled two = pull(sliding(kFreeSlip, 20.0, 0.03));
  EXPECT_GT(sticks, 0.1);
  for (const Pulled& each : {one, two}) {
    EXPECT_LT(std::abs(each.shear), 2e-3 * sticks);
    EXPECT_LT(std::abs(each.identity), 1e-4 * sticks);
  }
}

// With implicit viscosity fluid that runs into it meets its mirror image: a drag that grows with its
// viscosity. (By less than that goes: over a step the fluid is slowed.) With explicit viscosity the wall
// takes up the particle stress, and there is no mirror.
TEST(WallViscosity, AWallThatSlipsDragsWhatRunsIntoIt) {
  const auto solved = [](double upper) { return pull(sliding(kFreeSlip, upper, 0.06, 20.0), true); };
  const Pulled thin = solved(20.0), thick = solved(40.0), stepped = pull(sliding(kFreeSlip));
  std::printf("%.3f N by 20 Pa·s, %.3f N where half of it has 40; stepped, by 2 Pa·s, %.4f N\n", thin.shear,
              thick.shear, stepped.shear);
  ASSERT_TRUE(thin.solved && thick.solved && !stepped.solved);
  EXPECT_GT(thin.shear, 0.5);
  EXPECT_GT(thick.shear / thin.shear, 1.2);
  EXPECT_LT(thick.shear / thin.shear, 1.0 + 5.0 / 11.0);
  EXPECT_LT(std::abs(stepped.shear), 5e-3);
}

// By the law of action and reaction, and of its moments: what drags bears where the fluid is.
TEST(WallViscosity, WhatAWallThatSlipsTakesTheFluidLoses) {
  for (const double upper : {20.0, 40.0}) {
    const Pulled each = pull(sliding(kFreeSlip, upper, 0.06, 20.0), true);
    ASSERT_TRUE(each.solved);
    EXPECT_LT(std::abs(each.identity), 1e-4 * each.shear) << upper;
    EXPECT_LT(each.turning, 1e-4 * each.shear * 0.06) << upper;
  }
}

TEST(WallViscosity, EachFluidSticksByItsOwn) {
  const Pulled thin = pull(sliding(kFluidsViscosity, 0.02));
  const Pulled alike = pull(sliding(kFluidsViscosity));
  const Pulled thick = pull(sliding(kFluidsViscosity, 20.0));
  EXPECT_LT(thin.shear, 0.9 * alike.shear);
  EXPECT_GT(thick.shear, 1.5 * alike.shear);
  for (const Pulled& each : {thin, alike, thick})
    EXPECT_LT(std::abs(each.identity), 1e-4 * each.shear) << "what the fluid loses the walls get";
}

TEST(WallViscosity, TheMostThatIsAllowedGoesWithTheWalls) {
  const Scene scene = sliding(kFluidsViscosity);
  World world(scene, sample_scene(scene, kSpacing).value(), make_plan(scene, kSpacing),
              WorldOptions{1, Backend::kCpu});
  EXPECT_TRUE(world.set_viscosity(0, kViscosity));
  EXPECT_FALSE(world.set_viscosity(0, 1e4));
}

}  // namespace
}  // namespace slosh
