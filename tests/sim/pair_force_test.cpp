#include "sim/pair_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <random>

namespace slosh {
namespace {

constexpr double kSupport = 0.02;

using View = ParticleView<double>;

View random_particle(std::mt19937& random) {
  std::uniform_real_distribution<double> place(0.0, 0.012), speed(-1.0, 1.0), positive(0.5, 2.0);
  return {place(random), place(random),    place(random),           speed(random),   speed(random),
          speed(random), positive(random), 1e-6 * positive(random), positive(random)};
}

template <PairRule rule>
glm::dvec3 force(const View& p, const View& i) {
  ForceSum<double> sum{0.0, 0.0, 0.0};
  constexpr DragRule kDrag = rule == PairRule::kPaper ? DragRule::kAlongVelocity : DragRule::kCentral;
  add_pair_force<Spiky, rule, kDrag, true>(p, i, kSupport, 1.0, sum);
  return {sum.x, sum.y, sum.z};
}

glm::dvec3 position(const View& p) {
  return {p.x, p.y, p.z};
}

template <PairRule rule>
void expect_antisymmetric() {
  std::mt19937 random(11);
  for (int repeat = 0; repeat < 1000; ++repeat) {
    const View a = random_particle(random);
    const View b = random_particle(random);
    const glm::dvec3 ab = force<rule>(a, b);
    const glm::dvec3 ba = force<rule>(b, a);
    EXPECT_LE(glm::length(ab + ba), 1e-14 * glm::length(ab));
  }
}

TEST(PairForce, ConservesMomentum) {
  expect_antisymmetric<PairRule::kPaper>();
  expect_antisymmetric<PairRule::kConsistent>();
  expect_antisymmetric<PairRule::kWall>();
}

TEST(PairForce, ConsistentPairsConserveAngularMomentum) {
  std::mt19937 random(12);
  for (int repeat = 0; repeat < 1000; ++repeat) {
    const View a = random_particle(random);
    const View b = random_particle(random);
    const glm::dvec3 f = force<PairRule::kConsistent>(a, b);
    const glm::dvec3 d = position(a) - position(b);
    EXPECT_LE(glm::length(glm::cross(d, f)), 1e-12 * glm::length(d) * glm::length(f));
  }
}

TEST(PairForce, EquationNineMatchesTheFormula) {
  View p{0, 0, 0, 0.1, 0.2, 0.3, 100.0, 1e-6, 2.0};
  View i{0.01, 0, 0, -0.1, 0.5, 0.3, 300.0, 2e-6, 40.0};
  const double constant = 45.0 / (3.14159265358979323846 * std::pow(kSupport, 6));
  const glm::dvec3 f = constant * force<PairRule::kPaper>(p, i);
  // Eq 5: −V_p V_i (P_p + P_i)/2 ∇W; Eq 9: V_p V_i (μ_p + μ_i)/2 (v_i − v_p) ∇²W.
  const double pressure = -1e-6 * 2e-6 * 200.0 * constant * 0.01 * 0.01;  // p is pushed away from i, to −x
  const double viscosity = 1e-6 * 2e-6 * 21.0 * constant * 0.01;
  EXPECT_NEAR(f.x, pressure + viscosity * -0.2, 1e-9 * std::abs(pressure));
  EXPECT_NEAR(f.y, viscosity * 0.3, 1e-9 * std::abs(viscosity));
  EXPECT_NEAR(f.z, 0.0, 1e-15);
}

// In a linear velocity field the two viscosities are the same on average over directions (the factor 5).
TEST(PairForce, CentralDragHasTheViscosityOfEquationNine) {
  std::mt19937 random(13);
  std::normal_distribution<double> normal;
  glm::dvec3 paper(0.0), central(0.0);
  // u_x = y² has Laplacian (2, 0, 0): both sums over a shell must give the same force.
  for (int repeat = 0; repeat < 200000; ++repeat) {
    const glm::dvec3 d = 0.01 * glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    const View p{0, 0, 0, 0, 0, 0, 0.0, 1e-6, 1.0};
    const View i{d.x, d.y, d.z, d.y * d.y, 0, 0, 0.0, 1e-6, 1.0};
    paper += force<PairRule::kPaper>(p, i);
    central += force<PairRule::kConsistent>(p, i);
  }
  EXPECT_NEAR(central.x / paper.x, 1.0, 0.02);
}

TEST(PairForce, CoincidentParticlesAndSelfAddNothing) {
  const View p{0.1, 0.2, 0.3, 0.5, 0.5, 0.5, 1000.0, 1e-6, 1.0};
  EXPECT_EQ(glm::length(force<PairRule::kConsistent>(p, p)), 0.0);
  EXPECT_EQ(glm::length(force<PairRule::kPaper>(p, p)), 0.0);
}

}  // namespace
}  // namespace slosh
