// The reference of a ball that is let go, against closed forms of its parts.
#include "tests/lab/report/reference/released_ball.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace slosh::report {
namespace {

constexpr double kFar = 100.0, kGravity = 9.81;

// Lamb 1932, art. 99: half of what it displaces, three eighths of the cube of radius over distance more
// towards a wall, as much less towards a free surface.
TEST(ReleasedBall, WallAndSurfaceChangeItsAddedMass) {
  ReleasedBall ball{.width = kFar, .to_floor = kFar, .to_level = kFar};
  EXPECT_NEAR(added_mass(ball), 0.5, 1e-6);
  ball.to_floor = 0.07;
  EXPECT_NEAR(added_mass(ball), 0.5 * (1.0 + 0.375 * std::pow(0.02 / 0.07, 3)), 1e-5);
  ball.to_floor = kFar;
  ball.to_level = 0.09;
  EXPECT_NEAR(added_mass(ball), 0.5 * (1.0 - 0.375 * std::pow(0.02 / 0.09, 3)), 1e-5);
  // Side walls far from floor and surface: a square lattice of dipoles, Σ 1/r³ = 9.0336 (Zucker 1974).
  ball = {.width = 0.16, .to_floor = kFar, .to_level = kFar};
  EXPECT_NEAR(added_mass(ball), 0.5 * (1.0 + 1.5 * std::pow(0.02 / 0.16, 3) * 9.0336), 5e-4);
}

TEST(ReleasedBall, WithoutViscosityItGainsWhatBuoyancyGivesItsMass) {
  const ReleasedBall ball{.width = kFar, .to_floor = kFar, .to_level = kFar, .viscosity = 0.0};
  EXPECT_NEAR(mean_acceleration(ball, kGravity, 0.06), 0.5 * kGravity / (0.5 + 0.5), 1e-5);
}

// At first a boundary layer takes (4/3) H √t of a mass of 1, H Basset's factor: the integral of ∫ a/√(t − τ).
TEST(ReleasedBall, ABoundaryLayerTakesWhatBassetSays) {
  constexpr double kTime = 1e-3;
  ReleasedBall ball{.width = kFar, .to_floor = kFar, .to_level = kFar};
  const double with = mean_acceleration(ball, kGravity, kTime);
  ball.viscosity = 0.0;
  const double without = mean_acceleration(ball, kGravity, kTime);
  const double mass = 1000.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(ball.radius, 3);
  const double history = 6.0 * ball.radius * ball.radius * std::sqrt(std::numbers::pi * 1000.0 * 1e-3);
  const double expected = 4.0 / 3.0 * history * std::sqrt(kTime) / mass;
  EXPECT_NEAR(1.0 - with / without, expected, 0.03 * expected);
}

}  // namespace
}  // namespace slosh::report
