// The line through a fluid's wrench, from readings whose line is known.
#include "sim/bodies/wrench_identifier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "sim/passes/body_drag/body_drag.h"

namespace slosh {
namespace {

constexpr double kStep = 0.001;

// Drag of a patch of particles on one side of the centre of mass.
Matrix6 drag_of_patch(double size) {
  BodyDrag drag;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 arm(0.02 * (i & 1), -0.08 + 0.01 * (i >> 1 & 1), 0.015 * (i >> 2 & 1));
    drag.add({size / 8, 0.1 * size / 8, 0.0, size / 8, 0.0, 1.2 * size / 8}, arm);
  }
  return drag.matrix();
}

Vector6 times(const Matrix6& m, const Vector6& v) {
  Vector6 r{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) r[i] += m[i][j] * v[j];
  }
  return r;
}

/// A body that a hand moves, and a fluid of which all is known.
struct Known {
  Matrix6 drag = drag_of_patch(6.0);
  bool told_drag = true;  ///< the reading has it
  double c = 0.45;
  double m = 0.006;        // s of the drag
  double stiffness = 0.0;  // N/m, upright, at the patch's middle
  Vector6 held{0.0, 2.0, 0.0, 0.0, 0.0, 0.0};
  Vector6 rate{};
  double noise = 0.0;  // N
  double motion = 1.0;
  double time = 0.0;
  Vector6 x{}, v{};
  Wrench wrench;
  std::mt19937 random{7};

  FluidReading next() {
    const Vector6 before = v;
    time += kStep;
    const auto wave = [&](double size, double hz) { return size * std::cos(2.0 * M_PI * hz * time); };
    v = {motion * (wave(0.2, 1.3) + wave(0.1, 7.0)),
         motion * wave(0.05, 2.1),
         motion * wave(0.1, 0.8),
         motion * wave(0.4, 1.1),
         motion * wave(0.5, 3.0),
         motion * wave(0.3, 1.7)};
    Vector6 a;
    for (std::size_t i = 0; i < 6; ++i) {
      a[i] = (v[i] - before[i]) / kStep;
      x[i] += kStep * v[i];
    }
    const Vector6 dragged = times(drag, v);
    const Vector6 pushed = times(drag, a);
    const glm::dvec3 middle(0.01, -0.075, 0.0075);  // of the patch, but for the weights of its axes
    const Vector6 h{0.0, 1.0, 0.0, -middle.z, 0.0, middle.x};
    double way = 0.0;
    for (std::size_t i = 0; i < 6; ++i) way += h[i] * x[i];
    std::normal_distribution<double> any(0.0, 1.0);
    Vector6 w;
    for (std::size_t i = 0; i < 6; ++i) {
      w[i] = held[i] + rate[i] * time - c * dragged[i] - m * pushed[i] - stiffness * h[i] * way +
             noise * (i < 3 ? 1.0 : 0.08) * any(random);
    }
    wrench = {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
    return {time, center(), twist(), wrench, told_drag ? &drag : nullptr};
  }
  Pose center() const {
    return {{x[0], x[1], x[2]}, rotate_by(glm::dquat(1.0, 0.0, 0.0, 0.0), {x[3], x[4], x[5]})};
  }
  Twist twist() const { return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}; }
};

WrenchBounds bounds() {
  WrenchBounds b;
  b.body_mass = 0.3;
  b.gyration_squared = 1e-3;
  b.fluid_mass = 1.5;
  b.reach = 0.016;
  return b;
}

WrenchIdentifier after(Known& known, double seconds) {
  WrenchIdentifier found;
  found.restart(bounds());
  for (int i = 0; i < static_cast<int>(seconds / kStep); ++i) found.add(known.next());
  return found;
}

TEST(WrenchIdentifier, FindsTheDampingAndTheAddedMassThatAreThere) {
  Known known;
  const WrenchIdentifier found = after(known, 1.5);
  EXPECT_NEAR(found.damping(), known.c, 0.02 * known.c);
  EXPECT_NEAR(found.added_mass(), known.m, 0.03 * known.m);
  EXPECT_NEAR(found.stiffness(), 0.0, 1.0);
}

TEST(WrenchIdentifier, FindsTheStiffnessOfAWaterline) {
  Known known;
  known.stiffness = 98.0;
  const WrenchIdentifier found = after(known, 1.5);
  EXPECT_NEAR(found.stiffness(), 98.0, 20.0);
  EXPECT_NEAR(found.damping(), known.c, 0.05 * known.c);
}

TEST(WrenchIdentifier, WhereNothingMovesItStaysWithWhatTheParticlesSay) {
  Known known;
  known.motion = 0.0;
  known.noise = 0.02;
  const WrenchIdentifier found = after(known, 2.0);
  EXPECT_NEAR(found.damping(), 0.4, 0.02);
  EXPECT_LT(found.added_mass(), 2e-4);
  FluidWrenchModel model;
  found.fill(model);
  EXPECT_LT(glm::length(model.rate.force), 1.0) << "noise is carried on nowhere";
  EXPECT_LT(model.rate_span, 0.002);
}

TEST(WrenchIdentifier, WhatTheFluidDoesByItselfIsCarriedOn) {
  Known known;
  known.rate = {4.0, 0.0, -3.0, 0.0, 0.2, 0.0};
  const WrenchIdentifier found = after(known, 1.5);
  FluidWrenchModel model;
  found.fill(model);
  EXPECT_NEAR(model.rate.force.x, 4.0, 0.2);
  EXPECT_NEAR(model.rate.force.z, -3.0, 0.2);
  EXPECT_GT(model.rate_span, 0.02);
}

// The next ten milliseconds, of which the line knows nothing, with the body accelerated all the while.
TEST(WrenchIdentifier, TheLineIsTrueBetweenTwoStates) {
  Known known;
  known.rate = {2.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  const WrenchIdentifier found = after(known, 1.5);
  FluidWrenchModel model;
  found.fill(model);
  for (int i = 0; i < 10; ++i) {
    const Vector6 before = known.v;
    known.next();
    Vector6 a;
    for (std::size_t k = 0; k < 6; ++k) a[k] = (known.v[k] - before[k]) / kStep;
    Wrench felt = fluid_wrench(model, known.center(), known.twist(), known.time - model.time);
    const Vector6 inertial = times(model.added_mass, a);
    felt.force -= glm::dvec3(inertial[0], inertial[1], inertial[2]);
    felt.torque -= glm::dvec3(inertial[3], inertial[4], inertial[5]);
    EXPECT_LE(glm::distance(felt.force, known.wrench.force), 0.01) << i;
    EXPECT_LE(glm::distance(felt.torque, known.wrench.torque), 0.001) << i;
  }
}

TEST(WrenchIdentifier, NothingThatItSaysCanGiveEnergy) {
  // A fluid that pushes along: negative damping, negative mass, negative stiffness.
  Known known;
  known.c = -0.5;
  known.m = -0.01;
  known.stiffness = -200.0;
  const WrenchIdentifier found = after(known, 1.0);
  EXPECT_EQ(found.damping(), 0.0);
  EXPECT_EQ(found.added_mass(), 0.0);
  EXPECT_EQ(found.stiffness(), 0.0);
}

TEST(WrenchIdentifier, ABodyOutOfTheFluidFeelsNothing) {
  Known known;
  WrenchIdentifier found = after(known, 1.0);
  known.drag = Matrix6{};
  known.held = {};
  found.add(known.next());
  FluidWrenchModel model;
  found.fill(model);
  EXPECT_EQ(model.wrench.force, glm::dvec3(0.0));
  EXPECT_EQ(model.rate.force, glm::dvec3(0.0));
  EXPECT_EQ(model.d_velocity, Matrix6{});
  EXPECT_EQ(model.d_pose, Matrix6{});
  EXPECT_EQ(model.added_mass, Matrix6{});
  const Pose elsewhere{model.reference.position + glm::dvec3(0.01), model.reference.orientation};
  EXPECT_EQ(fluid_wrench(model, elsewhere, {{5.0, 0.0, 0.0}, {}}, 0.1).force, glm::dvec3(0.0));
}

TEST(WrenchIdentifier, WithoutViscosityTheAddedMassIsFoundAllTheSame) {
  Known known;
  known.drag = Matrix6{};
  for (std::size_t i = 0; i < 6; ++i) known.drag[i][i] = i < 3 ? 1.0 : bounds().gyration_squared;
  known.told_drag = false;
  known.c = 0.0;
  known.m = 0.035;  // kg
  const WrenchIdentifier found = after(known, 1.5);
  EXPECT_NEAR(found.added_mass(), 0.035, 0.002);
}

TEST(WrenchIdentifier, WhatIsNoNumberBeginsItAnew) {
  Known known;
  WrenchIdentifier found = after(known, 0.5);
  FluidReading bad = known.next();
  bad.wrench.force.x = std::numeric_limits<double>::quiet_NaN();
  found.add(bad);
  for (int i = 0; i < 600; ++i) found.add(known.next());
  FluidWrenchModel model;
  found.fill(model);
  EXPECT_TRUE(std::isfinite(model.wrench.force.x) && std::isfinite(model.rate.force.x));
  EXPECT_NEAR(found.damping(), known.c, 0.02);
}

}  // namespace
}  // namespace slosh
