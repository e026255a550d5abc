// Materials, gravity and sizes at the ends of their ranges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/lab/report/surface.h"
#include "tests/physics/lab.h"
#include "tests/support/tank.h"

namespace slosh::lab {
namespace {

// A dam break in a small tank whose fluid starts with `speed` (m/s) along x: everything moves.
Experiment dam(double viscosity, double height, double speed, double stiffness = 0.0) {
  SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  const int tank = b.add_fixed("tank", tank_at_floor({0.2, height, 0.1}, 0.03));
  b.scene.bodies[tank].dynamic_viscosity = viscosity;
  const int volume = b.add_volume(make::box({-0.1, 0.0, -0.05}, {0.0, 0.1, 0.05}));
  b.scene.fluid_volumes[volume].velocity = {speed, 0.0, 0.0};
  b.scene.stiffness = stiffness;
  b.set_domain({-0.4, -0.4, -0.4}, {0.4, 2.0, 0.4});
  return Experiment(b.scene, 0.01);
}

/// J, of the fluid above the floor.
double potential_energy(Experiment& e, double gravity) {
  const Diagnostics d = e.world().diagnostics();
  return d.mass * gravity * d.center.y;
}

class ViscosityRange : public ::testing::TestWithParam<double> {};

// 50 Pa·s lost a peer every particle to 10¹⁵ m. Energy never exceeds what it started with: the column's
// height.
TEST_P(ViscosityRange, dam_break_stays_bounded) {
  Experiment e = dam(GetParam(), 0.4, 0.0);
  const double energy = potential_energy(e, kGravity);
  double largest = 0.0;
  e.run(0.4, [&] {
    largest = std::max(largest, e.world().diagnostics().kinetic_energy + potential_energy(e, kGravity));
  });
  ASSERT_TRUE(all_finite(e.world()));
  // 2 %: kinetic energy is taken half a step before the height.
  EXPECT_LT(largest, 1.02 * energy);
  EXPECT_EQ(e.world().diagnostics().retired, 0u);
  EXPECT_EQ(e.world().take_status(), 0u);
}

INSTANTIATE_TEST_SUITE_P(pascal_seconds, ViscosityRange, ::testing::Values(0.0, 0.001, 1.0, 10.0, 50.0));

class Layers : public ::testing::TestWithParam<double> {};

// A light fluid on a heavy one stays on top; the floor carries both.
TEST_P(Layers, light_on_heavy_rest) {
  const double ratio = GetParam();
  testing::TankOptions options;
  options.inner = {0.1, 0.16, 0.1};
  options.fill = 0.05;
  options.rest_density = 1000.0;
  testing::Tank tank = testing::make_tank(options);
  Fluid light = tank.scene.fluids[0];
  light.rest_density = 1000.0 / ratio;
  // The same kinematic viscosity: a thousandth of the density at the same μ would be the limit of the step.
  light.dynamic_viscosity /= ratio;
  tank.scene.fluids.push_back(light);
  testing::add_fluid_block(tank.scene, tank.sampled, 1, {-0.05, 0.05, -0.05}, {0.05, 0.09, 0.05});
  Experiment e(tank.scene, tank.sampled);
  const std::size_t count = e.world().fluid_count();
  e.world().settle(0.3);
  e.run(0.2);
  Average down;
  e.run(0.2, [&] { down.add(-e.bodies().bodies[0].fluid.force.y); });
  ASSERT_TRUE(all_finite(e.world()));
  const Snapshot picture = e.picture();
  double heavy = 0.0, heavy_count = 0.0, lighter = 0.0, light_count = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    (picture.fluid_index[i] == 0 ? heavy : lighter) += picture.positions[i].y;
    (picture.fluid_index[i] == 0 ? heavy_count : light_count) += 1.0;
  }
  EXPECT_GT(lighter / light_count, heavy / heavy_count + 0.02);
  const std::string name = "layers 1:" + std::to_string(std::lround(ratio)) + ", floor";
  EXPECT_LT(std::abs(report(name, down.mean(), e.fluid_mass() * kGravity, "N")), 0.02);
  EXPECT_EQ(e.world().diagnostics().retired, 0u);
}

INSTANTIATE_TEST_SUITE_P(ratios, Layers, ::testing::Values(2.0, 10.0, 100.0, 1000.0));

// A light fluid that carries a heavy one is compressed as the heavy one is, not by their ratio more. It does
// not stay below, so it is looked at before it has gone.
TEST(LayersUpsideDown, light_below_heavy_is_not_squeezed) {
  SceneBuilder b;
  const int light = b.add_fluid(100.0, 0.2), heavy = b.add_fluid(1000.0, 2.0);
  b.add_fixed("tank", tank_at_floor({0.12, 0.2, 0.12}, 0.03));
  b.add_volume(make::box({-0.06, 0.0, -0.06}, {0.06, 0.04, 0.06}), light);
  b.add_volume(make::box({-0.06, 0.04, -0.06}, {0.06, 0.10, 0.06}), heavy);
  b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.4, 0.2});
  Experiment e(b.scene, 0.01);
  Average squeezed;
  double most = 0.0;
  e.run(0.1, [&] {
    squeezed.add(e.world().diagnostics().max_compression);
    most = std::max(most, e.world().diagnostics().max_compression);
  });
  report_value("light below heavy, largest compression, mean over 0.1 s", squeezed.mean(), "");
  report_value("light below heavy, largest compression", most, "");
  EXPECT_LT(squeezed.mean(), 0.1);
}

// What decides the stiffness: the whole stack of volumes, and what a start velocity or a script drives.
TEST(Stiffness, counts_the_stack_and_what_is_driven) {
  const auto stiffness = [](const SceneBuilder& b) { return make_plan(b.scene, 0.01).stiffness; };
  SceneBuilder one, stack, aside;
  for (SceneBuilder* b : {&one, &stack, &aside}) b->add_fluid(1000.0, 0.05);
  one.add_volume(make::box({0.0, 0.0, 0.0}, {0.1, 0.2, 0.1}));
  stack.add_volume(make::box({0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}));
  stack.add_volume(make::box({0.02, 0.1, 0.02}, {0.08, 0.2, 0.08}));
  aside.add_volume(make::box({0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}));
  aside.add_volume(make::box({0.1, 0.1, 0.0}, {0.2, 0.2, 0.1}));
  EXPECT_NEAR(stiffness(stack), stiffness(one), 1e-6 * stiffness(one));
  EXPECT_NEAR(stiffness(aside), 0.5 * stiffness(one), 1e-6 * stiffness(one));
  // Half of 2 m/s squared at 4 % is 50 m²/s² more.
  const double at_rest = stiffness(one);
  one.scene.fluid_volumes[0].velocity = {2.0, 0.0, 0.0};
  EXPECT_NEAR(stiffness(one), at_rest + 50.0, 1e-6);
  const int cup = aside.add_free("cup", make::box(glm::dvec3(-0.01), glm::dvec3(0.01)), 0.1);
  const double still = stiffness(aside);
  aside.add_grip(cup, 1e3, 10.0);
  aside.scene.grips[0].hand_motion = {{0.0, {}}, {0.5, {{1.0, 0.0, 0.0}, {1, 0, 0, 0}}}};
  EXPECT_NEAR(stiffness(aside), still + 50.0, 1e-6);
}

class GravityRange : public ::testing::TestWithParam<double> {};

TEST_P(GravityRange, tank_at_rest_carries_its_weight) {
  testing::TankOptions options;
  options.inner = {0.1, 0.16, 0.1};
  options.fill = 0.06;
  testing::Tank tank = testing::make_tank(options);
  const double gravity = kGravity * GetParam();
  tank.scene.gravity = {0.0, -gravity, 0.0};
  Experiment e(tank.scene, tank.sampled);
  e.world().settle(0.3);
  const double period = std::min(0.3, 0.3 / std::sqrt(GetParam() + 1e-12));
  Average down;
  e.run(period, [&] { down.add(-e.bodies().bodies[0].fluid.force.y); });
  ASSERT_TRUE(all_finite(e.world()));
  const Diagnostics fluid = e.world().diagnostics();
  if (gravity > 0.0) {
    EXPECT_NEAR(down.mean(), fluid.mass * gravity, 0.02 * fluid.mass * gravity);
  } else {
    EXPECT_NEAR(down.mean(), 0.0, 0.01);  // weightless fluid presses on nothing
    EXPECT_LT(fluid.max_speed, 0.01);
  }
  EXPECT_EQ(fluid.retired, 0u);
}

INSTANTIATE_TEST_SUITE_P(of_earth, GravityRange, ::testing::Values(0.0, 0.01, 1.0, 100.0));

class SpacingRange : public ::testing::TestWithParam<double> {};

// The same tank of 12 × 8 × 12 particles from drops to ponds: what is dimensionless must not change.
TEST_P(SpacingRange, tank_at_rest_carries_its_weight) {
  const double spacing = GetParam();
  testing::TankOptions options;
  options.spacing = spacing;
  options.inner = {12.0 * spacing, 16.0 * spacing, 12.0 * spacing};
  options.fill = 8.0 * spacing;
  // The same cell Reynolds number, ν ~ s·√(g s).
  options.viscosity = 0.05 * std::pow(spacing / 0.01, 1.5);
  const testing::Tank tank = testing::make_tank(options);
  Experiment e(tank.scene, tank.sampled);
  const double time = std::sqrt(8.0 * spacing / kGravity);
  e.world().settle(0.4);
  Average down;
  e.run(5.0 * time, [&] { down.add(-e.bodies().bodies[0].fluid.force.y); });
  ASSERT_TRUE(all_finite(e.world()));
  const double weight = e.fluid_mass() * kGravity;
  // The walls of the smallest tank stand 5 cm outside its mesh bounds only on paper: the boundary layer is
  // what counts.
  EXPECT_NEAR(down.mean(), weight, 0.02 * weight);
  EXPECT_EQ(e.world().diagnostics().retired, 0u);
}

INSTANTIATE_TEST_SUITE_P(metres, SpacingRange, ::testing::Values(0.001, 0.01, 0.1));

// What the depth of the dam below alone asks for, m²/s²: c = 5 m/s.
constexpr double kOfTheDepth = 24.525;

// Against a wall at 2 m/s. At the depth's stiffness this is an impact at Mach 0.4 and more: the fluid is
// crushed, and the status says so. (Until impacts were damped the penetration clamp had to hold it back
// besides.) The plan counts the start velocity, and it is not crushed. Nothing passes a wall.
TEST(Extremes, fluid_thrown_at_a_wall) {
  for (const double stiffness : {kOfTheDepth, 0.0, 400.0}) {
    Experiment e = dam(0.05, 0.5, 2.0, stiffness);
    e.run(0.25);  // the impact and the way up, before anything can fall out of the domain from over the wall
    ASSERT_TRUE(all_finite(e.world()));
    const double share =
        report::share_outside(e.picture(), Pose{}, {{-0.11, -0.01, -0.06}, {0.11, 0.4, 0.06}, true});
    const std::uint32_t status = e.world().take_status();
    report_value("fluid thrown at 2 m/s, stiffness " +
                     std::to_string(std::lround(e.world().plan().stiffness)) +
                     " m²/s², share pressed through walls",
                 100.0 * share, "%");
    if (stiffness == kOfTheDepth) {
      EXPECT_NE(status & kStatusCompressed, 0u) << status_text(status);
      EXPECT_EQ(status & kStatusClamped, 0u) << status_text(status);
    } else {
      EXPECT_EQ(status & kStatusCompressed, 0u) << status_text(status);
    }
    EXPECT_EQ(share, 0.0);
  }
}

// At 10 m/s with the depth's stiffness: it must say so, and lose only what it counts.
TEST(Extremes, fluid_thrown_too_fast_says_so) {
  Experiment e = dam(0.05, 0.5, 10.0, kOfTheDepth);
  const std::size_t count = e.world().fluid_count();
  e.run(1.0);
  ASSERT_TRUE(all_finite(e.world()));
  const Diagnostics fluid = e.world().diagnostics();
  EXPECT_EQ(fluid.particles + fluid.retired, count);
  EXPECT_NE(e.world().take_status() & (kStatusSpeedLimited | kStatusCompressed), 0u);
}

}  // namespace
}  // namespace slosh::lab
