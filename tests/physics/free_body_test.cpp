// Rigid bodies alone in space.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

glm::dvec3 angular_momentum(const Body& body, const BodyState& state) {
  const glm::dmat3 r = glm::mat3_cast(state.pose.orientation);
  return r * body.mass.inertia * glm::transpose(r) * state.twist.angular;
}

Scene alone(const make::Solid& solid, double mass, const Twist& twist) {
  SceneBuilder b;
  const int body = b.add_free("body", solid, mass);
  b.scene.bodies[body].twist = twist;
  b.scene.gravity = {0.0, 0.0, 0.0};
  b.set_domain({-10.0, -10.0, -10.0},
               {10.0, 10.0, 10.0});  // it flies for some metres and is not to leave the world
  return b.scene;
}

// A brick that tumbles about its middle axis, the unstable one. L is what is integrated, so it stays to
// rounding; the midpoint rule's energy error is second order in ω·dt (5 rad/s · 4 ms: 4e-4).
TEST(FreeBody, tumbling_brick_keeps_angular_momentum_and_energy) {
  const Scene scene =
      alone(make::box({-0.05, -0.02, -0.09}, {0.05, 0.02, 0.09}), 0.7, {{0.1, 0.2, -0.3}, {4.8, 0.1, 0.3}});
  const Body& body = scene.bodies[0];
  Experiment e(scene, 0.01);
  const BodyState start = e.bodies().bodies[0];
  const glm::dvec3 l0 = angular_momentum(body, start);
  const double energy0 = glm::dot(l0, start.twist.angular);
  double worst_momentum = 0.0, worst_energy = 0.0;
  bool flipped = false;
  e.run(10.0, [&] {
    const BodyState& now = e.bodies().bodies[0];
    const glm::dvec3 l = angular_momentum(body, now);
    worst_momentum = std::max(worst_momentum, glm::length(l - l0) / glm::length(l0));
    worst_energy = std::max(worst_energy, std::abs(glm::dot(l, now.twist.angular) / energy0 - 1.0));
    flipped = flipped || (glm::inverse(now.pose.orientation) * now.twist.angular).x < -3.0;
  });
  report_value("tumbling brick, angular momentum drift", worst_momentum, "");
  report_value("tumbling brick, energy drift", worst_energy, "");
  EXPECT_TRUE(flipped) << "the middle axis should turn over (Dzhanibekov)";
  EXPECT_LT(worst_momentum, 1e-12);
  EXPECT_LT(worst_energy, 1e-3);
  EXPECT_LT(
      glm::distance(e.bodies().bodies[0].center_of_mass, start.center_of_mass + 10.0 * start.twist.linear),
      1e-2);
  EXPECT_NEAR(glm::length(e.bodies().bodies[0].pose.orientation), 1.0, 1e-12);
}

// A disc: precession of its axis at L/I₁, the symmetric top's closed form.
TEST(FreeBody, symmetric_top_precesses_at_L_over_I) {
  const make::Solid disc = make::lathe({{0.0, -0.01}, {0.06, -0.01}, {0.06, 0.01}, {0.0, 0.01}}, 96);
  const Scene scene = alone(disc, 0.5, {{0, 0, 0}, {1.0, 6.0, 0.0}});
  const Body& body = scene.bodies[0];
  Experiment e(scene, 0.01);
  const glm::dvec3 l = angular_momentum(body, e.bodies().bodies[0]);
  const double rate = glm::length(l) / body.mass.inertia[0][0];
  const glm::dvec3 up = glm::normalize(l);
  // The angle that the disc's axis has turned about L.
  const auto across = [&] {
    const glm::dvec3 axis = e.bodies().bodies[0].pose.orientation * glm::dvec3(0, 1, 0);
    return glm::normalize(axis - up * glm::dot(axis, up));
  };
  glm::dvec3 last = across();
  double turned = 0.0;
  e.run(3.0, [&] {
    const glm::dvec3 now = across();
    turned += std::atan2(glm::dot(up, glm::cross(last, now)), glm::dot(last, now));
    last = now;
  });
  // Second order again: (12 rad/s · 4 ms)²/12 = 2e-4.
  EXPECT_LT(std::abs(report("symmetric top, precession", turned / e.world().time(), rate, "rad/s")), 1e-3);
}

// Symplectic Euler under constant force: velocity exact, position late by half a step.
TEST(FreeBody, falls_as_it_should) {
  SceneBuilder b;
  b.add_free("stone", make::sphere(0.03, 12, 24), 0.2);
  b.set_domain({-1, -20, -1}, {1, 1, 1});
  Experiment e(b.scene, 0.01);
  e.run(1.0);
  const double t = e.world().time();
  EXPECT_LT(std::abs(report("free fall, speed", -e.bodies().bodies[0].twist.linear.y, kGravity * t, "m/s")),
            1e-9);
  EXPECT_LT(
      std::abs(report("free fall, way", -e.bodies().bodies[0].center_of_mass.y, 0.5 * kGravity * t * t, "m")),
      5e-3);
}

}  // namespace
}  // namespace slosh::lab
