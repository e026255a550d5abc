// Whatever a model was learnt from: its damper takes energy, its spring gives back what it got at most, its
// added mass is one.
#include <gtest/gtest.h>

#include <random>

#include "scenes/load.h"
#include "scenes/sample.h"
#include "sim/fluid_models.h"
#include "sim/math/coupling.h"
#include "tests/support/places.h"

namespace slosh {
namespace {

class FluidWrenchIsPassive : public ::testing::TestWithParam<const char*> {};

Vector6 any(std::mt19937& random, double linear, double angular) {
  std::normal_distribution<double> normal;
  Vector6 v;
  for (std::size_t i = 0; i < 6; ++i) v[i] = (i < 3 ? linear : angular) * normal(random);
  return v;
}

double form(const Matrix6& m, const Vector6& v) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) sum += v[i] * m[i][j] * v[j];
  }
  return sum;
}

double size(const Matrix6& m) {
  double trace = 0.0;
  for (std::size_t i = 0; i < 6; ++i) trace += std::abs(m[i][i]);
  return trace;
}

void expect_symmetric(const Matrix6& m) {
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(m[i][j], m[j][i], 1e-12 * size(m));
  }
}

/// Held by wild hands, every step.
TEST_P(FluidWrenchIsPassive, InAnyStateOfTheScene) {
  const Scene scene = load_scene(find_scene(GetParam()).value()).value();
  const SampledScene sampled = sample_scene(scene, scene.spacing_max).value();
  World world(scene, sampled, make_plan(scene, scene.spacing_max), {1, Backend::kCpu});
  FluidModels models(scene);
  const std::vector<char> wanted(scene.bodies.size(), 1);
  BodySnapshot now;
  world.fill(now);
  std::vector<HandleInput> hands;
  for (const GripState& grip : now.grips) hands.push_back({grip.pose, {}, true, 1.0});
  // The probe's waits over the water; by chance alone it need not meet it.
  if (std::string(GetParam()) == "probe") hands.front().pose.position.y -= 0.05;
  const std::vector<HandleInput> start = hands;
  std::mt19937 random(static_cast<unsigned>(scene.name.size()));
  std::vector<FluidWrenchModel> out;
  std::size_t seen = 0;
  double damped = 0.0;
  for (int step = 0; step < 80; ++step) {
    if (step % 8 == 0) {
      for (HandleInput& hand : hands) {
        const Vector6 v = any(random, 0.4, 2.0);
        hand.twist = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
      }
    }
    for (std::size_t h = 0; h < hands.size(); ++h) {
      hands[h].pose = extrapolate(hands[h].pose, hands[h].twist, world.plan().time_step);
      const glm::dvec3 away = hands[h].pose.position - start[h].pose.position;
      if (glm::length(away) > 0.06) hands[h].twist.linear = -4.0 * away;
    }
    world.step(hands);
    world.fill(now);
    models.after_step(world, now, wanted, out);
    for (const FluidWrenchModel& model : out) {
      SCOPED_TRACE(std::string(GetParam()) + ", step " + std::to_string(step));
      seen += 1;
      for (const Matrix6* m : {&model.d_velocity, &model.d_pose, &model.added_mass}) expect_symmetric(*m);
      EXPECT_GE(model.trust_radius, 0.0);
      EXPECT_LE(model.trust_radius, 8.0 * world.plan().support_radius);
      for (int draw = 0; draw < 20; ++draw) {
        const Vector6 v = any(random, 1.0, 10.0);
        // To rounding of the sums over thousands of particles in single precision.
        EXPECT_LE(form(model.d_velocity, v), 1e-6 * size(model.d_velocity) * 100.0);
        EXPECT_LE(form(model.d_pose, v), 1e-9 * size(model.d_pose) * 100.0);
        EXPECT_GE(form(model.added_mass, v), -1e-6 * size(model.added_mass) * 100.0);
        damped -= form(model.d_velocity, v);
        // The same by what users of the model call, also beyond its trust.
        Pose at = model.reference;
        const Vector6 way = any(random, model.trust_radius, model.trust_angle);
        at.position += glm::dvec3(way[0], way[1], way[2]);
        Twist faster = model.twist;
        faster.linear += glm::dvec3(v[0], v[1], v[2]);
        faster.angular += glm::dvec3(v[3], v[4], v[5]);
        const Wrench slow = fluid_wrench(model, at, model.twist, 0.0);
        const Wrench fast = fluid_wrench(model, at, faster, 0.0);
        const double power = glm::dot(fast.force - slow.force, faster.linear - model.twist.linear) +
                             glm::dot(fast.torque - slow.torque, faster.angular - model.twist.angular);
        EXPECT_LE(power, 1e-6 * size(model.d_velocity) * 100.0);
      }
    }
  }
  EXPECT_GE(seen, 80u) << "a body was held";
  EXPECT_GT(damped, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Shipped, FluidWrenchIsPassive,
                         ::testing::Values("bucket", "spoon", "pour", "probe"));

}  // namespace
}  // namespace slosh
