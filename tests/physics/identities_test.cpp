// Momentum and angular momentum, step by step: what the fluid gains is what gravity and the walls gave it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/lab.h"
#include "tests/support/tank.h"

namespace slosh::lab {
namespace {

testing::Tank sloshing_tank(ParticleModel model) {
  testing::TankOptions options;
  options.inner = {0.16, 0.2, 0.12};
  options.fill = 0.08;
  options.wall_viscosity = 0.05;
  testing::Tank tank = testing::make_tank(options);
  tank.scene.model = model;
  tank.scene.gravity = {2.0, -9.81, 1.0};  // so that nothing is at rest and all three components count
  return tank;
}

class EachModel : public ::testing::TestWithParam<ParticleModel> {};

// Pair forces cancel to the last bits of a float and sums over bodies run in double: what is left is the
// rounding of float velocities, 6e-8 of their size, some 1e-6 of a step's g·dt.
TEST_P(EachModel, fluid_gains_what_gravity_and_walls_give) {
  const testing::Tank tank = sloshing_tank(GetParam());
  Experiment e(tank.scene, tank.sampled);
  const double dt = e.world().plan().time_step;
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    const Diagnostics before = e.world().diagnostics();
    e.step();
    const Diagnostics after = e.world().diagnostics();
    if (after.particles != before.particles)
      continue;  // the paper's walls leak: what left took its momentum along
    const glm::dvec3 given = dt * (before.mass * tank.scene.gravity - e.bodies().bodies[0].fluid.force);
    const double scale = dt * before.mass * kGravity;
    worst = std::max(worst, glm::length(after.momentum - before.momentum - given) / scale);
  }
  EXPECT_EQ(e.world().take_status() & kStatusSpeedLimited, 0u)
      << "a slowed particle's momentum is not given to anyone";
  report_value(std::string("momentum identity, ") + name(GetParam()) + " model, worst step, share of M g dt",
               worst, "");
  EXPECT_LT(worst, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(models, EachModel,
                         ::testing::Values(ParticleModel::kCorrected, ParticleModel::kConsistent,
                                           ParticleModel::kPaper),
                         [](const auto& p) { return name(p.param); });

// The same with a free box that falls into the fluid: box and fluid together.
TEST(Momentum, fluid_and_free_body_together) {
  testing::Tank tank = sloshing_tank(ParticleModel::kCorrected);
  SceneBuilder b;
  b.scene = tank.scene;
  const int box = b.add_free("box", make::box({-0.03, -0.03, -0.03}, {0.03, 0.03, 0.03}), 0.15,
                             {{0.0, 0.13, 0.0}, {1, 0, 0, 0}});
  // Sampled on its own and joined to the tank's sheets, which come without a mesh.
  SceneBuilder alone;
  alone.scene.bodies.push_back(b.scene.bodies[box]);
  alone.scene.meshes.push_back(b.scene.meshes[b.scene.bodies[box].mesh]);
  alone.scene.bodies[0].mesh = 0;
  const Result<SampledScene> sampled = sample_scene(alone.scene, tank.sampled.spacing);
  ASSERT_TRUE(sampled) << sampled.error().text();
  tank.sampled.surfaces.push_back(sampled.value().surfaces[0]);
  tank.sampled.distance_fields.push_back(sampled.value().distance_fields[0]);
  b.scene.domain_max.y += 0.2;
  Experiment e(b.scene, tank.sampled);
  const double dt = e.world().plan().time_step, box_mass = b.scene.bodies[box].mass.mass;
  const auto momentum = [&] {
    return e.world().diagnostics().momentum + box_mass * e.bodies().bodies[box].twist.linear;
  };
  const double mass = e.fluid_mass() + box_mass;
  double worst = 0.0;
  double fluid_on_box = 0.0;
  for (int i = 0; i < 150; ++i) {
    const glm::dvec3 before = momentum();
    e.step();
    const glm::dvec3 given = dt * (mass * b.scene.gravity - e.bodies().bodies[0].fluid.force);
    worst = std::max(worst, glm::length(momentum() - before - given) / (dt * mass * kGravity));
    fluid_on_box = std::max(fluid_on_box, e.bodies().bodies[box].fluid.force.y);
  }
  EXPECT_GT(fluid_on_box, 0.5 * box_mass * kGravity) << "the box never met the fluid: the test tests nothing";
  report_value("momentum identity with a free box, worst step, share of M g dt", worst, "");
  EXPECT_LT(worst, 1e-4);
}

// Angular momentum about the origin. Velocities are differences of positions (the snapshot has no others):
// float positions of 0.1 m over a step of 2 ms resolve 4e-6 m/s.
glm::dvec3 angular_momentum(const Snapshot& before, const Snapshot& after, double dt, double particle_mass) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < after.positions.size(); ++i) {
    const glm::dvec3 x(after.positions[i]);
    sum += glm::cross(x, (x - glm::dvec3(before.positions[i])) / dt);
  }
  return sum * particle_mass;
}

struct Turning {
  Scene scene;
  SampledScene sampled;
};

// A ball of fluid in free space whose inner half turns within the outer: nothing from outside acts on it.
Turning spinning_ball(ParticleModel model) {
  SceneBuilder b;
  b.add_fluid(1000.0, 1.0);
  b.add_volume(make::sphere(0.05, 24, 48));
  b.scene.gravity = {0.0, 0.0, 0.0};
  b.scene.stiffness = 25.0;
  b.scene.model = model;
  b.set_domain({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3});
  Turning t{b.scene, sample_scene(b.scene, 0.01).value()};
  for (std::size_t i = 0; i < t.sampled.fluid_positions.size(); ++i) {
    const glm::vec3 x = t.sampled.fluid_positions[i];
    if (glm::length(x) < 0.035f) t.sampled.fluid_velocities[i] = glm::cross(glm::vec3(0.0f, 8.0f, 0.0f), x);
  }
  return t;
}

double angular_momentum_drift(ParticleModel model) {
  const Turning t = spinning_ball(model);
  Experiment e(t.scene, t.sampled);
  const double dt = e.world().plan().time_step, mass = 1000.0 * std::pow(0.01, 3);
  Snapshot before = e.picture();
  e.step();
  Snapshot after = e.picture();
  const glm::dvec3 start = angular_momentum(before, after, dt, mass);
  for (int i = 0; i < 100; ++i) e.step();
  before = e.picture();
  e.step();
  after = e.picture();
  return glm::length(angular_momentum(before, after, dt, mass) - start) / glm::length(start);
}

// Central forces keep angular momentum. Eq 9 drags along the velocity difference, off the line between the
// particles, and loses most of it: both are shown, or the test would not notice a broken measurement.
TEST(AngularMomentum, consistent_model_keeps_it_and_eq_9_does_not) {
  const double consistent = angular_momentum_drift(ParticleModel::kConsistent);
  const double paper = angular_momentum_drift(ParticleModel::kPaper);
  const double corrected = angular_momentum_drift(ParticleModel::kCorrected);
  report_value("angular momentum lost in 100 steps, consistent", 100.0 * consistent, "%");
  report_value("angular momentum lost in 100 steps, corrected", 100.0 * corrected, "%");
  report_value("angular momentum lost in 100 steps, paper's Eq 9", 100.0 * paper, "%");
  EXPECT_LT(consistent, 1e-3);
  EXPECT_LT(corrected, 1e-3);
  EXPECT_GT(paper, 0.02);
}

// A closed box full of turning fluid: dL is what the walls' torque gave.
TEST(AngularMomentum, closed_container_takes_what_the_fluid_loses) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.5);
  const int tank = b.add_fixed("tank", tank_at_floor({0.12, 0.08, 0.12}, 0.03));
  const int lid = b.add_fixed("lid", make::box({-0.09, 0.081, -0.09}, {0.09, 0.12, 0.09}));
  b.add_volume(make::box({-0.06, 0.0, -0.06}, {0.06, 0.08, 0.06}));
  b.scene.gravity = {0.0, 0.0, 0.0};
  b.scene.stiffness = 25.0;
  b.set_domain({-0.15, -0.1, -0.15}, {0.15, 0.2, 0.15});
  SampledScene sampled = sample_scene(b.scene, 0.01).value();
  for (std::size_t i = 0; i < sampled.fluid_positions.size(); ++i) {
    sampled.fluid_velocities[i] = glm::cross(glm::vec3(0.0f, 6.0f, 0.0f), sampled.fluid_positions[i]);
  }
  Experiment e(b.scene, sampled);
  const double dt = e.world().plan().time_step, mass = 1000.0 * std::pow(0.01, 3);
  Snapshot before = e.picture();
  e.step();
  Snapshot after = e.picture();
  const glm::dvec3 start = angular_momentum(before, after, dt, mass);
  glm::dvec3 given(0.0);
  for (int i = 0; i < 150; ++i) {
    before = after;
    e.step();
    after = e.picture();
    given -= dt * (e.bodies().bodies[tank].fluid.torque + e.bodies().bodies[lid].fluid.torque);
  }
  const glm::dvec3 change = angular_momentum(before, after, dt, mass) - start;
  EXPECT_EQ(e.world().diagnostics().retired, 0u);
  EXPECT_LT(change.y, -0.3 * start.y) << "the walls hardly braked the fluid: the test tests little";
  EXPECT_LT(std::abs(report("angular impulse of the walls", given.y, change.y, "N·m·s")), 2e-3);
  EXPECT_LT(glm::length(given - change), 2e-3 * glm::length(change));
}

}  // namespace
}  // namespace slosh::lab
