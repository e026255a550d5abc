// Forces by a particle's viscous stress: exact in a linear flow, without net torque or power, and replaced by
// Eq 9 beside no-slip walls.
#include "sim/passes/fluid_stress/fluid_stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "sim/math/kernels.h"

namespace slosh {
namespace {

constexpr float kSupport = 0.02f, kSpacing = 0.01f, kVolume = 1e-6f, kViscosity = 3.0f;

float rest_moment() {
  double sum = 0.0;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        const float r2 = kSpacing * kSpacing * static_cast<float>(x * x + y * y + z * z);
        if (r2 > 0.0f && r2 < kSupport * kSupport)
          sum += static_cast<double>(kSpacing * kSpacing * static_cast<float>(x * x) *
                                     Spiky::pair(r2, kSupport, 1.0f).slope_over_r);
      }
  return static_cast<float>(sum);
}

// A particle at the origin that stands still, neighbours around it.
struct Around {
  std::vector<glm::vec3> places, velocities;
  glm::dmat3 moment{0.0};  // Σ d ⊗ d (−W'/r)

  glm::dvec3 g(std::size_t i) const {
    const glm::vec3 d = -places[i];
    return glm::dvec3(Spiky::pair(glm::dot(d, d), kSupport, 1.0f).slope_over_r * d);
  }
  FluidStress stress(float held = 0.0f) {
    StressSums s{};
    Symmetric<float> by_fluid{};
    moment = glm::dmat3(0.0);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const glm::vec3 d = -places[i], v = -velocities[i], w = glm::vec3(g(i));
      if (glm::dot(d, d) >= kSupport * kSupport) continue;
      const PairKernel<float> kernel = Spiky::pair(glm::dot(d, d), kSupport, 1.0f);
      add_moment(d.x, d.y, d.z, kernel, by_fluid);
      moment += glm::outerProduct(glm::dvec3(d), g(i));
      const float near = Spiky::shape_of(kernel);
      const auto add = [](Vector3<float>& sum, float factor, const glm::vec3& to) {
        sum = {sum.x + factor * to.x, sum.y + factor * to.y, sum.z + factor * to.z};
      };
      add(s.flow.carried.x, v.x, w), add(s.flow.carried.y, v.y, w), add(s.flow.carried.z, v.z, w);
      s.number += near;
      add(s.flow.offset, near, d), add(s.apart, near, v);
    }
    return fluid_stress(s, inverse_moment(by_fluid, rest_moment()), share_of_stress(held, rest_moment()),
                        rest_moment(), kVolume, kViscosity);
  }
};

glm::dvec3 vec3(const Vector3<float>& v) {
  return {v.x, v.y, v.z};
}
// T as GLM has it, by columns.
glm::dmat3 matrix(const Matrix3<float>& t) {
  return glm::transpose(glm::dmat3(vec3(t.x), vec3(t.y), vec3(t.z)));
}

enum class Where { kInside, kSurface, kLayer };
Around around(Where where, std::mt19937& random) {
  std::uniform_real_distribution<float> jitter(-0.25f, 0.25f);
  Around a;
  const int top = where == Where::kInside ? 2 : 0, bottom = where == Where::kLayer ? 0 : -2;
  for (int x = -2; x <= 2; ++x)
    for (int y = bottom; y <= top; ++y)
      for (int z = -2; z <= 2; ++z)
        if (x != 0 || y != 0 || z != 0)
          a.places.push_back(kSpacing * (glm::vec3(x, y, z) +
                                         glm::vec3(jitter(random), 0.2f * jitter(random), jitter(random))));
  return a;
}
glm::dmat3 any_matrix(std::mt19937& random) {
  std::uniform_real_distribution<double> rate(-20.0, 20.0);
  glm::dmat3 m;
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k) m[j][k] = rate(random);
  return m;
}
double size_of(const glm::dmat3& m) {
  return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

TEST(FluidStress, OfANeighbourOfWhichRoundingLeavesNothingIsNone) {
  StressSums sums{};
  sums.apart = {1e-9f, 0.0f, 0.0f};
  InverseMoment<float> moment{};
  moment.inverse = {1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f};
  moment.kept = 1e-20f;
  for (const float number : {0.0f, -1e-13f}) {
    sums.number = number;
    const FluidStress found = fluid_stress(sums, moment, 1.0f, rest_moment(), kVolume, kViscosity);
    EXPECT_EQ(found.rest.x, 0.0f) << number;
    EXPECT_EQ(found.rest.y, 0.0f);
    EXPECT_TRUE(std::isfinite(found.push.x.x));
  }
}

// What a particle pushes with is V τ M⁻¹, τ Newton's, at a surface as inside; nothing is left to be braked.
TEST(FluidStress, IsNewtonsInALinearFlow) {
  std::mt19937 random(7);
  for (const Where where : {Where::kInside, Where::kSurface}) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      Around a = around(where, random);
      const glm::dmat3 gradient = any_matrix(random);
      for (const glm::vec3& x : a.places) a.velocities.emplace_back(gradient * glm::dvec3(x));
      const FluidStress found = a.stress();
      const glm::dmat3 newton = static_cast<double>(kViscosity) * (gradient + glm::transpose(gradient));
      const glm::dmat3 passed = matrix(found.push) * a.moment;
      EXPECT_LT(size_of(passed + static_cast<double>(kVolume) * newton),
                2e-5 * static_cast<double>(kVolume) * size_of(newton));
      EXPECT_LT(glm::length(vec3(found.rest)), 2e-5);
      EXPECT_EQ(found.left, 0.0f);
    }
  }
}

TEST(FluidStress, IsNothingInRigidRotation) {
  std::mt19937 random(8);
  for (const Where where : {Where::kInside, Where::kSurface, Where::kLayer}) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      Around a = around(where, random);
      const glm::dvec3 spin = any_matrix(random)[0];
      for (const glm::vec3& x : a.places) a.velocities.emplace_back(glm::cross(spin, glm::dvec3(x)));
      const double like = 2.0 * static_cast<double>(kViscosity * kVolume) * glm::length(spin);
      EXPECT_LT(size_of(matrix(a.stress().push) * a.moment), 1e-5 * like);
    }
  }
}

// Whatever the velocities are and however flat the neighbourhood: the forces of one particle exert no net
// torque, and the power that its fluid loses by them is V τ : G, never below 0.
TEST(FluidStress, ExertsNoTorqueAndGivesNoPower) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> speed(-0.3f, 0.3f);
  for (const Where where : {Where::kInside, Where::kSurface, Where::kLayer}) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      Around a = around(where, random);
      for (std::size_t i = 0; i < a.places.size(); ++i)
        a.velocities.emplace_back(speed(random), speed(random), speed(random));
      const glm::dmat3 t = matrix(a.stress().push);
      glm::dvec3 torque(0.0);
      double size = 0.0, power = 0.0, powers = 0.0;
      for (std::size_t i = 0; i < a.places.size(); ++i) {
        const glm::dvec3 d = -glm::dvec3(a.places[i]);
        if (glm::length(d) >= static_cast<double>(kSupport)) continue;
        const glm::dvec3 push = t * a.g(i);  // on the particle, and −push on the neighbour
        torque += glm::cross(d, push);
        size += glm::length(d) * glm::length(push);
        power += glm::dot(push, -glm::dvec3(a.velocities[i]));
        powers += std::abs(glm::dot(push, glm::dvec3(a.velocities[i])));
      }
      ASSERT_GT(size, 0.0);
      EXPECT_LT(glm::length(torque), 1e-5 * size);
      EXPECT_LT(power, 1e-5 * powers) << "drag takes power";
    }
  }
}

TEST(FluidStress, LeavesEq9ItsPlaceBesideWallsThatHold) {
  std::mt19937 random(10);
  Around a = around(Where::kInside, random);
  const glm::dmat3 gradient = any_matrix(random);
  for (const glm::vec3& x : a.places) a.velocities.emplace_back(gradient * glm::dvec3(x));
  const FluidStress whole = a.stress(), half = a.stress(0.5f * kNoSlipReach * rest_moment()),
                    none = a.stress(kNoSlipReach * rest_moment());
  EXPECT_NEAR(size_of(matrix(half.push)) / size_of(matrix(whole.push)), 0.5, 1e-5);
  EXPECT_FLOAT_EQ(half.left, 0.5f * kNearNoSlipWalls * kViscosity);
  EXPECT_EQ(size_of(matrix(none.push)), 0.0);
  EXPECT_FLOAT_EQ(none.left, kNearNoSlipWalls * kViscosity);
}

// A pair far from all others drags as before: two drops of syrup that meet do not spring back.
TEST(FluidStress, LeavesEq9ItsPlaceWhereNobodyElseIs) {
  Around a;
  a.places = {kSpacing * glm::vec3(0.6f, 0.7f, 0.1f)};
  a.velocities = {glm::vec3(-1.0f, 0.0f, 0.0f)};
  EXPECT_FLOAT_EQ(a.stress().left, kNearNoSlipWalls * kViscosity);
  std::mt19937 random(12);
  Around layer = around(Where::kLayer, random);
  layer.velocities.assign(layer.places.size(), glm::vec3(-1.0f, 0.0f, 0.0f));
  EXPECT_GT(layer.stress().left, 0.7f * kNearNoSlipWalls * kViscosity);
}

// One that moves alone is braked by a quarter of the viscosity of what its velocity differs by; one without
// neighbours feels nothing.
TEST(FluidStress, BrakesWhatIsNoPartOfTheFlow) {
  std::mt19937 random(11);
  Around a = around(Where::kInside, random);
  a.velocities.assign(a.places.size(), glm::vec3(-1.0f, 0.0f, 0.0f));
  const FluidStress alone = a.stress();
  EXPECT_NEAR(alone.rest.x, kResidualDamping * kViscosity, 0.2f * kResidualDamping * kViscosity);
  const FluidStress nobody = Around{}.stress();
  EXPECT_EQ(size_of(matrix(nobody.push)), 0.0);
  EXPECT_EQ(nobody.rest.x, 0.0f);
}

}  // namespace
}  // namespace slosh
