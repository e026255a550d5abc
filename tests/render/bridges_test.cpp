// Samples that are drawn between few particles.
#include "render/passes/bridges.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace slosh {
namespace {

constexpr float kRadius = 0.01f;

/// What is added to particles along x, in radii; their fluids are 0 unless given.
std::vector<glm::vec3> added(std::vector<glm::vec3> particles, std::vector<std::uint8_t> fluids = {}) {
  for (glm::vec3& p : particles) p *= kRadius;
  fluids.resize(particles.size(), 0);
  Frame frame;
  frame.particles = particles;
  frame.particle_fluid = fluids;
  frame.fluids.resize(2);
  frame.particle_radius = kRadius;
  Bridges bridges;
  bridges.add(frame);
  EXPECT_GE(frame.particles.size(), particles.size());
  EXPECT_EQ(frame.particles.size(), frame.particle_fluid.size());
  std::vector<glm::vec3> more;
  for (std::size_t i = 0; i < frame.particles.size(); ++i) {
    const FluidSample sample = fluid_sample(frame.particle_fluid[i]);
    EXPECT_EQ(sample.between, i >= particles.size()) << i;
    if (i < particles.size())
      EXPECT_EQ(sample.fluid, fluids[i]);
    else
      more.push_back(frame.particles[i] / kRadius);
  }
  std::ranges::sort(more, {}, &glm::vec3::x);
  return more;
}

TEST(Bridges, AStreamsGapsAreClosedInTheirMiddle) {
  const auto more = added({{0, 0, 0}, {2.6f, 0, 0}, {5.9f, 0, 0}});
  ASSERT_EQ(more.size(), 2u);
  EXPECT_NEAR(more[0].x, 1.3f, 1e-4f);
  EXPECT_NEAR(more[1].x, 4.25f, 1e-4f);
  EXPECT_EQ(more[0].y, 0.0f);
}

TEST(Bridges, DropsPartAndWideGapsStay) {
  EXPECT_TRUE(added({{0, 0, 0}, {2.6f, 0, 0}}).empty()) << "two by themselves";
  EXPECT_TRUE(added({{0, 0, 0}, {3.6f, 0, 0}, {7.2f, 0, 0}}).empty());
  EXPECT_TRUE(added({{0, 0, 0}, {1.7f, 0, 0}, {3.4f, 0, 0}}).empty()) << "close to each other: no gap";
  EXPECT_TRUE(added({}).empty());
}

TEST(Bridges, WhoIsInTheMiddleIsTheBridge) {
  // Between the first and the third lies the second, a little aside: two short ways and no long one.
  const auto more = added({{0, 0, 0}, {1.6f, 0.4f, 0}, {3.2f, 0, 0}});
  EXPECT_TRUE(more.empty());
}

TEST(Bridges, FluidsAreNotJoined) {
  EXPECT_TRUE(added({{0, 0, 0}, {2.6f, 0, 0}, {5.2f, 0, 0}}, {0, 1, 0}).empty());
  EXPECT_EQ(added({{0, 0, 0}, {2.6f, 0, 0}, {5.2f, 0, 0}}, {1, 1, 0}).size(), 1u);
  EXPECT_TRUE(added({{0, 0, 0}, {2.6f, 0, 0}, {5.2f, 0, 0}}, {255, 255, 255}).empty()) << "not drawn";
}

TEST(Bridges, TheOrderOfParticlesSaysNothing) {
  std::vector<glm::vec3> particles;
  unsigned state = 7;
  const auto next = [&] {
    return static_cast<float>((state = state * 1664525u + 1013904223u) >> 8) / (1 << 24);
  };
  for (int i = 0; i < 300; ++i) particles.emplace_back(30.0f * next(), 12.0f * next(), 4.0f * next());
  const auto one = added(particles);
  std::ranges::reverse(particles);
  const auto other = added(particles);
  EXPECT_GT(one.size(), 50u);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(glm::distance(one[i], other[i]), 0.0f, 1e-4f);
}

TEST(Bridges, MuchFluidStaysAsItIs) {
  // 20 x 20 x 20 at a spacing: its edges alone have so few neighbours that anything may be added there.
  std::vector<glm::vec3> particles;
  for (int i = 0; i < 8000; ++i)
    particles.push_back(1.61f * glm::vec3(i % 20, i / 20 % 20, i / 400) + 0.01f * static_cast<float>(i % 7));
  for (const glm::vec3& p : added(particles)) {
    int at_sides = 0;
    for (int axis = 0; axis < 3; ++axis) at_sides += p[axis] < 1.7f || p[axis] > 1.61f * 18 ? 1 : 0;
    EXPECT_GE(at_sides, 2) << p.x << " " << p.y << " " << p.z;
  }
}

}  // namespace
}  // namespace slosh
