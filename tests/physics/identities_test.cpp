// Momentum and angular momentum, step by step: what the fluid gains is what gravity and the walls gave it.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/run_constants.h"
#include "sim/saved_state.h"
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
  EXPECT_LT(worst, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(models, EachModel,
                         ::testing::Values(ParticleModel::kCorrected, ParticleModel::kPaper,
                                           ParticleModel::kIncompressible),
                         [](const auto& p) { return name(p.param); });

// The same with a free box that falls into the fluid: box and fluid together.
class Corrected : public ::testing::TestWithParam<ParticleModel> {};

TEST_P(Corrected, momentum_of_fluid_and_free_body_together) {
  testing::Tank tank = sloshing_tank(GetParam());
  SceneBuilder b;
  b.scene = tank.scene;
  const int box = b.add_free("box", make::box({-0.03, -0.03, -0.03}, {0.03, 0.03, 0.03}), 0.15,
                             {{0.0, 0.13, 0.0}, {1, 0, 0, 0}});
  // Sampled on its own and joined to the tank's boundary layers, which come without a mesh.
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
    const Diagnostics fluid = e.world().diagnostics();
    return fluid.momentum + fluid.clamp_impulse + box_mass * e.bodies().bodies[box].twist.linear;
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
  report_value(std::string("momentum identity with a free box, ") + name(GetParam()) +
                   " model, worst step, share of M g dt",
               worst, "");
  EXPECT_LT(worst, 1e-6);
}

// Angular momentum about the origin. Velocities are differences of positions (the snapshot has no others):
// float positions of 0.1 m over a step of 2 ms resolve 4e-6 m/s.
glm::dvec3 whole_angular_momentum(const Snapshot& before, const Snapshot& after, double dt,
                                  double particle_mass) {
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
  const glm::dvec3 start = whole_angular_momentum(before, after, dt, mass);
  for (int i = 0; i < 100; ++i) e.step();
  before = e.picture();
  e.step();
  after = e.picture();
  return glm::length(whole_angular_momentum(before, after, dt, mass) - start) / glm::length(start);
}

// Central forces keep angular momentum. Eq 9 drags along the velocity difference, off the line between the
// particles, and loses most of it: both are shown, or the test would not notice a broken measurement.
TEST(AngularMomentum, central_forces_keep_it_and_eq_9_does_not) {
  const double paper = angular_momentum_drift(ParticleModel::kPaper);
  const double corrected = angular_momentum_drift(ParticleModel::kCorrected);
  const double incompressible = angular_momentum_drift(ParticleModel::kIncompressible);
  report_value("angular momentum lost in 100 steps, incompressible", 100.0 * incompressible, "%");
  EXPECT_LT(incompressible, 1e-3);
  report_value("angular momentum lost in 100 steps, corrected", 100.0 * corrected, "%");
  report_value("angular momentum lost in 100 steps, paper's Eq 9", 100.0 * paper, "%");
  EXPECT_LT(corrected, 1e-3);
  EXPECT_GT(paper, 0.02);
}

// A closed box full of turning fluid: dL is what the walls' torque gave.
TEST_P(Corrected, closed_container_takes_the_angular_momentum_that_the_fluid_loses) {
  SceneBuilder b;
  b.scene.model = GetParam();
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
  const glm::dvec3 start = whole_angular_momentum(before, after, dt, mass);
  glm::dvec3 given(0.0);
  for (int i = 0; i < 150; ++i) {
    before = after;
    e.step();
    after = e.picture();
    given -= dt * (e.bodies().bodies[tank].fluid.torque + e.bodies().bodies[lid].fluid.torque);
  }
  const glm::dvec3 change = whole_angular_momentum(before, after, dt, mass) - start;
  EXPECT_EQ(e.world().diagnostics().retired, 0u);
  EXPECT_LT(change.y, -0.3 * start.y) << "the walls hardly braked the fluid: the test tests little";
  EXPECT_LT(std::abs(report("angular impulse of the walls", given.y, change.y, "N·m·s")), 1e-5);
  EXPECT_LT(glm::length(given - change), 1e-5 * glm::length(change));
}

INSTANTIATE_TEST_SUITE_P(models, Corrected,
                         ::testing::Values(ParticleModel::kCorrected, ParticleModel::kIncompressible),
                         [](const auto& p) { return name(p.param); });

// Momentum and angular momentum about the origin, fluid and bodies, of the floats that the world has: saved
// and read again, with position and the velocity half a step behind it as the leap-frog keeps them.
class Totals {
 public:
  explicit Totals(const report::Trial& e, const Scene& scene, const Plan& plan)
      : sampled_(e.sampled()), constants_(make_run_constants(scene, sampled_, plan)) {
    for (const Body& body : scene.bodies) bodies_.push_back(make_rigid_body(body));
    frame_ = state_frame(scene, constants_.plan, make_particle_start(scene, sampled_, constants_, bodies_));
  }

  struct Momenta {
    glm::dvec3 linear{0.0}, angular{0.0};
  };
  Momenta of(const World& world) const {
    std::vector<std::uint8_t> bytes;
    EXPECT_TRUE(world.save(bytes));
    SavedState state;
    state.bodies = bodies_;
    EXPECT_TRUE(read_state(bytes, frame_, constants_, state));
    Momenta sum;
    const ParticleState& p = state.particles;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const glm::dvec3 momentum = double{constants_.kinds[0].mass} * glm::dvec3(p.vx[i], p.vy[i], p.vz[i]);
      sum.linear += momentum;
      sum.angular += glm::cross(glm::dvec3(p.x[i], p.y[i], p.z[i]), momentum);
    }
    for (const RigidBody& body : state.bodies) {
      sum.linear += body.mass * body.velocity;
      sum.angular += glm::cross(body.position, body.mass * body.velocity) + body.angular_momentum;
    }
    // What walls took from particles in the last step, and their bodies get in the next.
    for (std::size_t b = 0; b < state.bodies.size(); ++b) {
      const Wrench on_the_way = impulse_wrench(
          std::span(state.walls).subspan(kImpulseWords * b, kImpulseWords), constants_.impulse_units, 1.0);
      sum.linear += on_the_way.force;
      sum.angular += on_the_way.torque + glm::cross(state.bodies[b].position, on_the_way.force);
    }
    return sum;
  }

 private:
  SampledScene sampled_;
  RunConstants constants_;
  std::vector<RigidBody> bodies_;
  StateFrame frame_;
};

struct HoneyCase {
  const char* name;
  ParticleModel model;
  double viscosity;  // Pa·s
  bool solved;       // drag implicit in the whole fluid
  double angular;    // of the momentum in a step, at most
};
class Honey : public ::testing::TestWithParam<HoneyCase> {};

// A light box that turns and moves in a ball of honey in free space: what it loses the honey gains, in every
// step, though the box's drag is taken at the step's end. The corrected pressure is not central: 7e-3 and
// 2e-2 of the angular momentum were lost where a wall's layers beyond the moment's one bore where its
// particles are.
TEST_P(Honey, box_gives_what_the_fluid_takes) {
  SceneBuilder b;
  b.add_fluid(1000.0, GetParam().viscosity);
  b.add_volume(make::sphere(0.05, 24, 48));
  constexpr double kEdge = 0.03;
  const int box = b.add_free("box", make::box(glm::dvec3(-0.5 * kEdge), glm::dvec3(0.5 * kEdge)),
                             0.05 * 1000.0 * std::pow(kEdge, 3));
  b.scene.bodies[box].twist = {{0.05, 0.0, 0.02}, {0.0, 20.0, 5.0}};
  b.scene.gravity = {0.0, 0.0, 0.0};
  b.scene.stiffness = 25.0;
  b.scene.model = GetParam().model;
  b.set_domain({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3});
  report::Setting setting;
  setting.model = GetParam().model;
  setting.spacing = 0.01;
  setting.threads = 1;
  setting.solve_viscosity = GetParam().solved;
  report::Cost cost;
  report::Trial e(b.scene, setting, cost);
  const Plan plan = e.world().plan();
  ASSERT_TRUE(plan.has(GetParam().solved ? PassId::kImplicitViscosity : PassId::kBodyDrag));
  const Totals totals(e, b.scene, plan);
  const Totals::Momenta start = totals.of(e.world());
  Totals::Momenta before = start;
  double linear = 0.0, angular = 0.0;
  for (int i = 0; i < 100; ++i) {
    e.step();
    const Totals::Momenta now = totals.of(e.world());
    linear = std::max(linear, glm::length(now.linear - before.linear) / glm::length(start.linear));
    angular = std::max(angular, glm::length(now.angular - before.angular) / glm::length(start.angular));
    before = now;
  }
  EXPECT_LT(glm::length(e.bodies().bodies[box].twist.angular), 1.0) << "the honey hardly braked the box";
  const std::string model = GetParam().name;
  report_value("light box in honey, momentum lost in a step, " + model, linear, "");
  report_value("light box in honey, angular momentum lost in a step, " + model, angular, "");
  EXPECT_LT(linear, 1e-5);
  EXPECT_LT(angular, GetParam().angular);
}

INSTANTIATE_TEST_SUITE_P(
    Models, Honey,
    ::testing::Values(HoneyCase{"corrected", ParticleModel::kCorrected, 20.0, false, 1e-5},
                      HoneyCase{"incompressible", ParticleModel::kIncompressible, 20.0, false, 1e-5},
                      HoneyCase{"incompressible_solved", ParticleModel::kIncompressible, 50.0, true, 1e-5},
                      HoneyCase{"solved", ParticleModel::kCorrected, 50.0, true, 1e-5}),
    [](const auto& p) { return p.param.name; });

// A closed vessel in free space whose fluid is thrown at its walls, far too fast for its stiffness: what
// walls take from particles that would pass them, the vessel gets, to the rounding of the particles' floats.
TEST(ClampedWalls, give_their_body_what_they_take_from_particles) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.01);
  constexpr double kHalf = 0.05, kWall = 0.015;
  make::Solid hollow = make::box(glm::dvec3(-kHalf), glm::dvec3(kHalf));
  for (glm::uvec3& t : hollow.triangles) std::swap(t.y, t.z);
  const int vessel = b.add_free(
      "vessel", make::merged(make::box(glm::dvec3(-kHalf - kWall), glm::dvec3(kHalf + kWall)), hollow), 0.5);
  b.add_volume(make::box(glm::dvec3(-kHalf), {kHalf, 0.0, 0.03}));
  b.scene.gravity = {0.0, 0.0, 0.0};
  b.scene.stiffness = 9.0;
  b.scene.model = ParticleModel::kCorrected;
  b.set_domain(glm::dvec3(-1.0), glm::dvec3(1.0));
  SampledScene sampled = sample_scene(b.scene, 0.01).value();
  for (glm::vec3& v : sampled.fluid_velocities) v = {1.8f, 0.3f, 0.1f};
  // Short steps, so that nothing is faster than the speed limit: who is slowed gives to nobody.
  report::Setting setting;
  setting.model = b.scene.model;
  setting.step_share = 0.25;
  setting.threads = 1;
  report::Cost cost;
  report::Trial e(b.scene, sampled, setting, cost);
  const Totals totals(e, b.scene, e.world().plan());
  const Totals::Momenta start = totals.of(e.world());
  // Goes on from a step with impulses on their way, on two threads.
  setting.threads = 2;
  report::Trial twin(b.scene, sampled, setting, cost);
  bool saved = false;
  double linear = 0.0, angular = 0.0;
  for (int i = 0; i < 400; ++i) {
    e.step();
    if (saved) {
      twin.step();
    } else if (e.world().diagnostics().clamp_impulse.x > 0.0) {
      std::vector<std::uint8_t> bytes;
      ASSERT_TRUE(e.world().save(bytes));
      ASSERT_TRUE(twin.world().restore(bytes));
      saved = true;
    }
    const Totals::Momenta now = totals.of(e.world());
    linear = std::max(linear, glm::length(now.linear - start.linear) / glm::length(start.linear));
    angular = std::max(angular, glm::length(now.angular - start.angular) / glm::length(start.angular));
  }
  const double clamped = static_cast<double>(e.world().diagnostics().clamped);
  report_value("thrown vessel, particles put back", clamped, "");
  report_value("thrown vessel, momentum lost in 400 steps", linear, "");
  report_value("thrown vessel, angular momentum lost in 400 steps", angular, "");
  EXPECT_GT(clamped, 40.0) << "the test tests little";
  EXPECT_GT(e.bodies().bodies[vessel].twist.linear.x, 0.2);
  EXPECT_EQ(cost.status & kStatusSpeedLimited, 0u);
  EXPECT_LT(linear, 1e-5);
  EXPECT_LT(angular, 1e-5);
  ASSERT_TRUE(saved);
  EXPECT_EQ(twin.world().hash(), e.world().hash());
  EXPECT_EQ(twin.world().diagnostics().clamped, e.world().diagnostics().clamped);
}

}  // namespace
}  // namespace slosh::lab
