#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "sim/bodies/body_solve.h"
#include "sim/math/gauss.h"

namespace slosh {
namespace {

Body brick() {
  Body body;
  body.name = "brick";
  body.motion = BodyMotion::kFree;
  body.mass.mass = 2.0;
  body.mass.inertia = glm::dmat3(0.0);
  body.mass.inertia[0][0] = 0.01;
  body.mass.inertia[1][1] = 0.02;
  body.mass.inertia[2][2] = 0.05;
  return body;
}

void advance(RigidBody& body, const Wrench& external, std::span<const ActiveCoupling> couplings, double dt) {
  BodySolve solve;
  ASSERT_TRUE(solve_body(body, external, couplings, dt, solve));
  advance_body(body, solve, dt);
}

ActiveCoupling hold(const RigidBody& body, const Pose& local, const Pose& handle, CouplingGains gains) {
  ActiveCoupling coupling;
  coupling.gains = gains;
  coupling.handle = handle;
  coupling.grip_pose = compose(body.mesh_pose(), local);
  coupling.arm = coupling.grip_pose.position - body.position;
  return coupling;
}

TEST(Cholesky, SolvesAndRefuses) {
  Matrix6 a{};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) a[i][j] = 1.0 / (1.0 + std::abs(i - j));
    a[i][i] += 2.0;
  }
  Matrix6 lower;
  ASSERT_TRUE(cholesky(a, lower));
  const Vector6 b{1, -2, 3, 0.5, 0, 7};
  const Vector6 x = cholesky_solve(lower, b);
  for (int i = 0; i < 6; ++i) {
    double sum = 0.0;
    for (int j = 0; j < 6; ++j) sum += a[i][j] * x[j];
    EXPECT_NEAR(sum, b[i], 1e-12);
  }
  a[3][3] = -1.0;
  EXPECT_FALSE(cholesky(a, lower));
  a[3][3] = std::nan("");
  EXPECT_FALSE(cholesky(a, lower));
}

TEST(Gauss, SolvesWhatNeedsItsRowsSwappedAndRefusesTheSingular) {
  std::array<double, 9> a{0, 2, 1, 1, -2, -3, -1, 1, 2};
  std::array<double, 3> x{-8, 0, 3};
  ASSERT_TRUE(solve_dense(a, x));
  EXPECT_NEAR(x[0], -4.0, 1e-14);
  EXPECT_NEAR(x[1], -5.0, 1e-14);
  EXPECT_NEAR(x[2], 2.0, 1e-14);
  std::array<double, 4> singular{1, 2, 2, 4}, nan{1, 2, std::nan(""), 4};
  std::array<double, 2> b{1, 1};
  EXPECT_FALSE(solve_dense(singular, b));
  EXPECT_FALSE(solve_dense(nan, b));
}

TEST(RigidBody, KeepsAngularMomentumWhileItTumbles) {
  Body source = brick();
  source.twist.angular = {3.0, 0.1, 0.0};  // about the middle axis it would flip; near the first it wobbles
  RigidBody body = make_rigid_body(source);
  const glm::dvec3 momentum = body.angular_momentum;
  const double energy = 0.5 * glm::dot(body.angular_velocity, momentum);
  for (int i = 0; i < 10000; ++i) advance(body, {}, {}, 1e-3);
  EXPECT_LE(glm::length(body.angular_momentum - momentum), 1e-12 * glm::length(momentum));
  EXPECT_NEAR(0.5 * glm::dot(body.angular_velocity, body.angular_momentum), energy, 1e-3 * energy);
}

TEST(RigidBody, FallsAsGravitySays) {
  RigidBody body = make_rigid_body(brick());
  const double dt = 1e-3;
  for (int i = 0; i < 1000; ++i) advance(body, {glm::dvec3(0, -9.81 * body.mass, 0), {}}, {}, dt);
  EXPECT_NEAR(body.position.y, -0.5 * 9.81 * (1.0 + dt), 1e-9);
}

TEST(Coupling, HangsByItsSpring) {
  RigidBody body = make_rigid_body(brick());
  const CouplingGains gains{1000.0, 60.0, 20.0, 0.5};
  Wrench felt;
  for (int i = 0; i < 5000; ++i) {
    const ActiveCoupling c[] = {hold(body, {}, {}, gains)};
    BodySolve solve;
    ASSERT_TRUE(solve_body(body, {glm::dvec3(0, -9.81 * body.mass, 0), {}}, c, 1e-3, solve));
    felt = coupling_wrench(c[0], solve, 1e-3);
    advance_body(body, solve, 1e-3);
  }
  EXPECT_NEAR(body.position.y, -9.81 * body.mass / gains.stiffness, 1e-6);
  EXPECT_NEAR(felt.force.y, 9.81 * body.mass, 1e-4);
}

TEST(Coupling, NoStiffnessBlowsTheStepUp) {
  Body light = brick();
  light.mass.mass = 1e-3;
  light.mass.inertia *= 1e-4;
  RigidBody body = make_rigid_body(light);
  const Pose grip{{0.1, 0.0, 0.0}, {1, 0, 0, 0}};
  for (int i = 0; i < 2000; ++i) {
    const double side = (i / 100) % 2 ? 0.05 : -0.05;  // a hand that jumps ten centimetres
    std::vector<ActiveCoupling> hands;
    for (int n = 0; n < 16; ++n) {
      hands.push_back(hold(body, grip, {{0.1 + side, 0.01 * n, 0.0}, {1, 0, 0, 0}}, {1e6, 0.0, 1e4, 0.0}));
    }
    advance(body, {glm::dvec3(0, -9.81 * body.mass, 0), {}}, hands, 4e-3);
    ASSERT_LT(glm::length(body.position), 1.0);
    ASSERT_LT(glm::length(body.velocity), 100.0);
  }
}

TEST(Coupling, OffCentreGripTurnsTheBody) {
  RigidBody body = make_rigid_body(brick());
  const Pose grip{{0.2, 0.0, 0.0}, {1, 0, 0, 0}};
  const ActiveCoupling c[] = {hold(body, grip, {{0.2, 0.05, 0.0}, {1, 0, 0, 0}}, {500.0, 1.0, 0.0, 0.0})};
  advance(body, {}, c, 1e-3);
  EXPECT_GT(body.velocity.y, 0.0);
  EXPECT_GT(body.angular_velocity.z, 0.0);
}

TEST(Coupling, PointBodyDoesNotTurn) {
  Body probe = brick();
  probe.point_probe = true;
  RigidBody body = make_rigid_body(probe);
  const ActiveCoupling c[] = {
      hold(body, {{0.2, 0, 0}, {1, 0, 0, 0}}, {{0.2, 0.05, 0}, {1, 0, 0, 0}}, {500, 1, 5, 1})};
  for (int i = 0; i < 100; ++i) advance(body, {{0, 0, 0}, {1, 1, 1}}, c, 1e-3);
  EXPECT_EQ(body.angular_velocity, glm::dvec3(0.0));
  EXPECT_EQ(body.orientation, glm::dquat(1, 0, 0, 0));
}

TEST(CouplingWrenchOnHand, PullsTheHandTowardsTheGrip) {
  const CouplingGains gains{100.0, 2.0, 3.0, 0.0};
  const Pose handle{};
  const Pose grip{{0.1, 0.0, 0.0}, glm::angleAxis(0.5, glm::dvec3(0, 0, 1))};
  const Wrench w = coupling_wrench_on_hand(gains, handle, {{1, 0, 0}, {0, 0, 0}}, grip, {});
  EXPECT_NEAR(w.force.x, 10.0 - 2.0, 1e-12);
  EXPECT_NEAR(w.torque.z, 1.5, 1e-9);
}

TEST(Pose, RotationBetweenAndRotateByAreInverse) {
  const glm::dquat from = glm::normalize(glm::dquat(0.3, -0.4, 0.5, 0.7));
  for (const glm::dvec3 turn : {glm::dvec3(0.3, -1.0, 2.0), glm::dvec3(1e-9, 0, 0), glm::dvec3(0, 3.1, 0)}) {
    const glm::dvec3 back = rotation_between(from, rotate_by(from, turn));
    EXPECT_LE(glm::length(back - turn), 1e-9);
  }
}

}  // namespace
}  // namespace slosh
