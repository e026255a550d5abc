// What has set: it holds together and keeps what a solid keeps; it tears, and it melts.
#include "sim/passes/bonds/bonds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/passes/heat/conduction.h"
#include "sim/world.h"
#include "tests/support/tank.h"

namespace slosh {
namespace {

using testing::Tank;

constexpr double kGrain = 0.01;       // m
constexpr double kModulus = 20000.0;  // Pa

/// A block of set batter that floats in space, `cells` particles along each axis.
Tank floating(const glm::ivec3& cells) {
  Tank tank;
  Fluid fluid;
  fluid.name = "batter";
  fluid.dynamic_viscosity = 0.5;
  fluid.heat.melts_above = 60.0;
  fluid.heat.melts_in = 0.1;
  fluid.heat.starts_set = true;
  fluid.heat.modulus = kModulus;
  fluid.heat.capacity = 1000.0;
  tank.scene.fluids.push_back(fluid);
  tank.scene.gravity = glm::dvec3(0.0);
  tank.scene.domain_min = glm::dvec3(-1.0);
  tank.scene.domain_max = glm::dvec3(1.0);
  tank.sampled.spacing = kGrain;
  const glm::dvec3 half = 0.5 * kGrain * glm::dvec3(cells);
  testing::add_fluid_block(tank.scene, tank.sampled, 0, -half, half);
  return tank;
}

World run_on_cpu(const Tank& tank, int threads = 1) {
  return World(tank.scene, tank.sampled, make_plan(tank.scene, tank.sampled.spacing),
               {threads, Backend::kCpu});
}

void run(World& world, double seconds) {
  const double end = world.time() + seconds;
  while (world.time() < end) world.step({});
}

struct Moving {
  glm::dvec3 momentum{0.0}, about_origin{0.0};
  double width = 0.0;  // m, along x
};
Moving moving(const World& world, double mass) {
  std::vector<glm::vec3> velocities;
  world.fill_velocities(velocities);
  Snapshot now;
  world.fill(now);
  Moving all;
  double low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    // Velocities are half a step behind.
    const glm::dvec3 v(velocities[i]), x = glm::dvec3(now.positions[i]) - 0.5 * world.plan().time_step * v;
    all.momentum += mass * v;
    all.about_origin += mass * glm::cross(x, v);
    low = std::min(low, x.x);
    high = std::max(high, x.x);
  }
  all.width = high - low;
  return all;
}
constexpr double kGrainMass = 1000.0 * kGrain * kGrain * kGrain;

TEST(Bonds, StiffnessMakesTheModulusOfALattice) {
  // 6 bonds of one spacing and 12 of √2; μ = stiffness · Σ L / (30 V), E = 2.5 μ.
  const double lengths = kGrain * (6.0 + 12.0 * std::sqrt(2.0));
  const double shear = bond_stiffness(kModulus, kGrain) * lengths / (30.0 * std::pow(kGrain, 3));
  EXPECT_NEAR(2.5 * shear, kModulus, 1e-6 * kModulus);
}

TEST(Bonds, AreOnlyInPlansOfWhatBecomesElastic) {
  Tank tank = floating({4, 4, 4});
  EXPECT_TRUE(make_plan(tank.scene, kGrain).has(PassId::kBonds));
  tank.scene.fluids[0].heat.modulus = 1e7;
  EXPECT_LT(make_plan(tank.scene, kGrain).time_step, 0.5 * kGrain / 99.0);
  tank.scene.fluids[0].heat.modulus = 0.0;
  EXPECT_FALSE(make_plan(tank.scene, kGrain).has(PassId::kBonds));
  EXPECT_TRUE(make_plan(tank.scene, kGrain).has(PassId::kHeat));
}

// Thrown, spun and shaken it keeps both momenta to rounding.
TEST(Bonds, KeepMomentumAndAngularMomentum) {
  Tank tank = floating({8, 6, 6});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> shake(-0.2f, 0.2f);
  for (std::size_t i = 0; i < tank.sampled.fluid_positions.size(); ++i) {
    const glm::vec3& x = tank.sampled.fluid_positions[i];
    tank.sampled.fluid_velocities[i] = glm::vec3(0.1f, 0.05f, 0.0f) +
                                       glm::cross(glm::vec3(1.0f, 4.0f, 2.0f), x) +
                                       glm::vec3(shake(random), shake(random), shake(random));
  }
  World world = run_on_cpu(tank);
  const Moving before = moving(world, kGrainMass);
  run(world, 0.3);
  const Moving after = moving(world, kGrainMass);
  EXPECT_LT(glm::length(after.momentum - before.momentum), 1e-5 * glm::length(before.momentum));
  EXPECT_LT(glm::length(after.about_origin - before.about_origin), 2e-3 * glm::length(before.about_origin));
  std::printf("  momentum moved by %.1e of it, angular momentum by %.1e\n",
              glm::length(after.momentum - before.momentum) / glm::length(before.momentum),
              glm::length(after.about_origin - before.about_origin) / glm::length(before.about_origin));
}

// A rod stretched along itself comes back after half the period of its first mode, L √(ρ/E).
TEST(Bonds, ARodRingsAsItsModulusSays) {
  Tank tank = floating({32, 6, 6});
  const double length = 32 * kGrain;
  constexpr double kPi = 3.14159265358979323846;
  for (std::size_t i = 0; i < tank.sampled.fluid_positions.size(); ++i) {
    const double x = tank.sampled.fluid_positions[i].x;
    tank.sampled.fluid_velocities[i].x = static_cast<float>(0.05 * std::sin(kPi * x / length));
  }
  World world = run_on_cpu(tank);
  const double before = moving(world, kGrainMass).width;
  double last = 0.0, back = 0.0, longest = 0.0;
  while (back == 0.0 && world.time() < 1.0) {
    world.step({});
    const double more = moving(world, kGrainMass).width - before;
    longest = std::max(longest, more);
    if (last > 0.0 && more <= 0.0) back = world.time() - world.plan().time_step * more / (more - last);
    last = more;
  }
  const double expected = length * std::sqrt(1000.0 / kModulus);
  std::printf("  half a period %.4f s, expected %.4f (%+.1f %%)\n", back, expected,
              100.0 * (back / expected - 1.0));
  EXPECT_NEAR(back / expected, 1.0, 0.1);
  EXPECT_NEAR(longest, 2.0 * 0.05 * expected / kPi, 0.1 * longest);
}

// Two halves that part: what they have in motion is less than tearing takes, or more.
TEST(Bonds, HoldBelowTheStrainTheyTearAtAndTearAboveIt) {
  const auto parted = [](float speed) {
    Tank tank = floating({16, 4, 4});
    tank.scene.fluids[0].heat.tears_at = 0.2;
    for (std::size_t i = 0; i < tank.sampled.fluid_positions.size(); ++i)
      tank.sampled.fluid_velocities[i].x = tank.sampled.fluid_positions[i].x > 0.0f ? speed : -speed;
    World world = run_on_cpu(tank);
    run(world, 0.4);
    return moving(world, kGrainMass).width;
  };
  // ρ v² / 2 against E ε² / 2 at ε = 0.2: 0.9 m/s.
  EXPECT_LT(parted(0.2f), 0.16 * 1.1);
  EXPECT_GT(parted(2.0f), 0.6);
}

TEST(Bonds, AreGoneWhereItMelts) {
  Tank tank = floating({6, 6, 6});
  tank.scene.fluids[0].heat.temperature = 80.0;
  for (std::size_t i = 0; i < tank.sampled.fluid_positions.size(); ++i)
    tank.sampled.fluid_velocities[i] = glm::vec3(3.0f) * tank.sampled.fluid_positions[i];
  World warm = run_on_cpu(tank);
  tank.scene.fluids[0].heat.temperature = 20.0;
  World cold = run_on_cpu(tank);
  run(warm, 0.5);
  run(cold, 0.5);
  EXPECT_EQ(warm.diagnostics().cure, 0.0);
  EXPECT_EQ(cold.diagnostics().cure, 1.0);
  EXPECT_GT(moving(warm, kGrainMass).width, 0.09);
  EXPECT_NEAR(moving(cold, kGrainMass).width, 0.05, 0.01);
}

TEST(Bonds, AreTheSameToTheBit) {
  Tank tank = floating({10, 5, 5});
  tank.scene.fluids[0].heat.tears_at = 0.1;
  for (std::size_t i = 0; i < tank.sampled.fluid_positions.size(); ++i)
    tank.sampled.fluid_velocities[i] = glm::vec3(12.0f * tank.sampled.fluid_positions[i].x, 0.0f, 0.0f);
  World one = run_on_cpu(tank, 1), two = run_on_cpu(tank, 2);
  run(one, 0.05);
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(one.save(saved));
  run(one, 0.05);
  run(two, 0.05);
  run(two, 0.05);
  EXPECT_EQ(one.hash(), two.hash());
  World again = run_on_cpu(tank);
  const Result<bool> restored = again.restore(saved);
  ASSERT_TRUE(restored) << restored.error().text();
  run(again, 0.05);
  EXPECT_EQ(again.hash(), one.hash());
  // A bond to nobody.
  saved[saved.size() - 2] ^= 0xff;
  saved.resize(saved.size() - 1);
  EXPECT_FALSE(again.restore(saved));
}

TEST(Bonds, SetWhileItRuns) {
  Tank tank = floating({6, 6, 6});
  Heat& heat = tank.scene.fluids[0].heat;
  heat.starts_set = false;
  heat.sets_below = 30.0;
  heat.sets_in = 0.1;
  for (std::size_t i = 0; i < tank.sampled.fluid_positions.size(); ++i)
    tank.sampled.fluid_velocities[i] = glm::vec3(0.3f) * tank.sampled.fluid_positions[i];
  World world = run_on_cpu(tank);
  run(world, 0.3);
  EXPECT_EQ(world.diagnostics().cure, 1.0);
  EXPECT_LT(moving(world, kGrainMass).width, 0.058);
}

}  // namespace
}  // namespace slosh
