// What a particle's neighbours flow by: nothing is left of a linear flow, on whichever side they lie.
#include "sim/viscosity/neighbour_flow.h"

#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "sim/math/kernels.h"
#include "sim/viscosity/artificial_viscosity.h"

namespace slosh {
namespace {

constexpr float kSupport = 0.02f, kSpacing = 0.01f;

struct Sums {
  Neighborhood<float> around{};
  FlowSums<float> flow{};
  float own = 0.0f, rest = 0.0f;
};

// A particle at the origin at `v`, and neighbours at `places` at `velocities`.
Sums sums_of(const glm::vec3& v, const std::vector<glm::vec3>& places,
             const std::vector<glm::vec3>& velocities) {
  Sums s;
  s.own = Spiky::shape_of(Spiky::pair(0.0f, kSupport, 1.0f));
  s.around.fluid_number = s.own;
  s.around.vx = s.own * v.x, s.around.vy = s.own * v.y, s.around.vz = s.own * v.z;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::vec3 d = -places[i], w = velocities[i];
    if (glm::dot(d, d) >= kSupport * kSupport) continue;
    add_fluid_neighbor<Spiky>(d.x, d.y, d.z, w.x, w.y, w.z, kSupport, 1.0f, s.around);
    add_flow<Spiky>({d.x, d.y, d.z}, {w.x, w.y, w.z}, kSupport, s.flow);
  }
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        const float r2 = kSpacing * kSpacing * static_cast<float>(x * x + y * y + z * z);
        if (r2 > 0.0f && r2 < kSupport * kSupport)
          s.rest +=
              kSpacing * kSpacing * static_cast<float>(x * x) * Spiky::pair(r2, kSupport, 1.0f).slope_over_r;
      }
  return s;
}

void follow(Sums& s, const glm::vec3& v) {
  follow_flow(flow_around(s.flow, {v.x, v.y, v.z}), inverse_moment(s.around.moment, s.rest), s.rest,
              s.around);
}

// m/s that it differs from its neighbours by.
glm::vec3 fluctuation(const Sums& s, const glm::vec3& v) {
  float u[3] = {};
  add_fluctuation(s.around, s.own, 1.0f, {v.x, v.y, v.z}, u);
  follow_fluctuation(s.around, s.own, 1.0f, u);
  return {u[0], u[1], u[2]};
}

std::vector<glm::vec3> half_space(std::mt19937& random) {
  std::uniform_real_distribution<float> jitter(-0.25f, 0.25f);
  std::vector<glm::vec3> places;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 0; ++y)
      for (int z = -2; z <= 2; ++z)
        if (x != 0 || y != 0 || z != 0)
          places.push_back(kSpacing * (glm::vec3(x, y, z) +
                                       glm::vec3(jitter(random), 0.5f * jitter(random), jitter(random))));
  return places;
}

TEST(NeighbourFlow, LeavesNothingOfALinearFlowAtASurface) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> rate(-20.0f, 20.0f);
  float by_mean = 0.0f;
  for (int repeat = 0; repeat < 100; ++repeat) {
    const std::vector<glm::vec3> places = half_space(random);
    glm::mat3 gradient;
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) gradient[j][k] = rate(random);
    const glm::vec3 v(rate(random) * 0.05f, rate(random) * 0.05f, rate(random) * 0.05f);
    std::vector<glm::vec3> velocities;
    for (const glm::vec3& x : places) velocities.push_back(v + gradient * x);
    Sums s = sums_of(v, places, velocities);
    by_mean = std::max(by_mean, glm::length(fluctuation(s, v)));
    follow(s, v);
    EXPECT_LT(glm::length(fluctuation(s, v)), 2e-5f);
  }
  EXPECT_GT(by_mean, 0.05f) << "against the mean, the flow itself counts as fluctuation";
}

// What a particle alone does is seen whole, however its neighbours lie: it is in G too, but by no more than
// the offset of their middle.
TEST(NeighbourFlow, SeesWhatAParticleDoesAlone) {
  std::mt19937 random(8);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const std::vector<glm::vec3> places = half_space(random);
    const glm::vec3 v(1.0f, 0.0f, 0.0f);
    Sums s = sums_of(v, places, std::vector<glm::vec3>(places.size(), glm::vec3(0.0f)));
    follow(s, v);
    const glm::vec3 u = fluctuation(s, v);
    EXPECT_GT(u.x, 0.1f);
    EXPECT_LE(u.x, 1.0f);
    EXPECT_LT(std::abs(u.y) + std::abs(u.z), 1e-6f);
  }
}

// A layer and a pair tell nothing of what lies beside them: the mean is all there is.
TEST(NeighbourFlow, KeepsTheMeanWhereNeighboursLieInALayer) {
  std::vector<glm::vec3> places, velocities;
  for (int x = 0; x <= 2; ++x)
    for (int z = -2; z <= 2; ++z)
      if (x != 0 || z != 0) {
        places.push_back(kSpacing * glm::vec3(x, 0, z));
        velocities.emplace_back(x, z, 0.5f);
      }
  for (const std::size_t count : {places.size(), std::size_t{1}}) {
    places.resize(count), velocities.resize(count);
    Sums s = sums_of(glm::vec3(0.0f), places, velocities);
    follow(s, glm::vec3(0.0f));
    EXPECT_EQ(s.around.fx, 0.0f);
    EXPECT_EQ(s.around.fy, 0.0f);
    EXPECT_EQ(s.around.fz, 0.0f);
  }
}

}  // namespace
}  // namespace slosh
