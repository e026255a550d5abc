// What is read of a world, against what was put into it.
#include "sim/instruments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scenes/make/solid.h"
#include "scenes/sample.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kSpacing = 0.01;  // m

/// Water 80 mm deep in a tank of 0.2 x 0.1 m that can be moved, with a gauge and two regions on it.
Scene tank_of_water() {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  const int tank = b.add_free("tank", lab::tank_at_floor({0.2, 0.15, 0.1}, 0.03), 2.0);
  b.add_volume(make::box({-0.1, 0.0, -0.05}, {0.1, 0.08, 0.05}));
  b.set_domain({-1.0, -0.5, -1.0}, {1.0, 1.0, 1.0});
  Scene scene = b.scene;
  scene.gauges.push_back({"middle", tank, {0.0, 0.0, 0.0}});
  scene.gauges.push_back({"outside", -1, {0.5, 0.0, 0.0}});
  lab::SceneBuilder shapes;
  shapes.add_volume(make::box({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2}));
  shapes.add_volume(make::box({0.0, -0.1, -0.2}, {0.2, 0.3, 0.2}));
  for (const char* name : {"all", "right half"}) {
    scene.meshes.push_back(shapes.scene.meshes[scene.regions.size()]);
    scene.regions.push_back({name, static_cast<int>(scene.meshes.size()) - 1, tank, {}});
  }
  return scene;
}

TEST(Instruments, ReadLevelAndMassOfStillWater) {
  const Scene scene = tank_of_water();
  const SampledScene sampled = sample_scene(scene, kSpacing).value();
  World world(scene, sampled, make_plan(scene, kSpacing), WorldOptions{1, Backend::kCpu});
  Instruments instruments(scene, sampled);
  const Measurement& m = instruments.measure(world);
  const double whole = static_cast<double>(sampled.fluid_positions.size()) * 1e-3;  // kg, at 1 g a particle
  ASSERT_EQ(m.levels.size(), 2u);
  double top = 0.0;
  for (const glm::vec3& p : sampled.fluid_positions) top = std::max(top, static_cast<double>(p.y));
  EXPECT_NEAR(m.levels[0], top + 0.5 * kSpacing, 0.1 * kSpacing) << "half a spacing above the last layer";
  EXPECT_TRUE(std::isnan(m.levels[1])) << "no fluid there";
  EXPECT_NEAR(m.masses[0], whole, 1e-9);
  EXPECT_NEAR(m.masses[1], 0.5 * whole, 0.01 * whole);
  EXPECT_EQ(m.fluid.particles, sampled.fluid_positions.size());
  EXPECT_EQ(m.in_solids, 0u);
  EXPECT_EQ(m.fluid.retired, 0u);
}

class PressureOf : public ::testing::TestWithParam<ParticleModel> {};

// Eq 7 of the particles' own densities, whichever way a model presses with it. Eq 5's mean of two pressures
// is half of the gradient that it stands for, so the published model's fluid has twice the pressure that it
// should, and some more.
TEST_P(PressureOf, still_water_grows_with_depth) {
  Scene scene = tank_of_water();
  scene.bodies[0].motion = BodyMotion::kFixed;
  scene.model = GetParam();
  scene.gauges = {
      {"deep", -1, {0.0, 0.025, 0.0}}, {"shallow", -1, {0.0, 0.055, 0.0}}, {"above", -1, {0.0, 0.14, 0.0}}};
  const SampledScene sampled = sample_scene(scene, kSpacing).value();
  World world(scene, sampled, make_plan(scene, kSpacing), WorldOptions{1, Backend::kCpu});
  Instruments instruments(scene, sampled);
  const Measurement& at_start = instruments.measure(world);
  EXPECT_EQ(at_start.pressures[0], 0.0) << "nothing has been stepped";
  EXPECT_TRUE(std::isnan(at_start.pressures[2])) << "no fluid there";
  world.settle(0.6);
  double gained = 0.0;
  constexpr int kReadings = 20;
  for (int i = 0; i < kReadings; ++i) {
    for (int n = 0; n < 5; ++n) world.step({});
    const Measurement& now = instruments.measure(world);
    gained += (now.pressures[0] - now.pressures[1]) / kReadings;
    EXPECT_TRUE(std::isnan(now.pressures[2]));
  }
  const double expected = 1000.0 * 9.81 * 0.03;
  const double right = GetParam() == ParticleModel::kPaper ? 2.4 : 1.0;
  EXPECT_NEAR(gained / expected, right, 0.1 * right) << "Pa gained from 25 to 55 mm, over ρgh";
}

INSTANTIATE_TEST_SUITE_P(models, PressureOf,
                         ::testing::Values(ParticleModel::kPaper, ParticleModel::kCorrected),
                         [](const auto& p) { return std::string(name(p.param)); });

TEST(Pressures, OfWhatHasLeftTheWorldAreNone) {
  const Scene scene = tank_of_water();
  SampledScene sampled = sample_scene(scene, kSpacing).value();
  sampled.fluid_positions[3] = {1e6f, 0.0f, 0.0f};
  World world(scene, sampled, make_plan(scene, kSpacing), WorldOptions{1, Backend::kCpu});
  world.step({});
  std::vector<float> pressures;
  world.fill_pressures(pressures);
  ASSERT_EQ(pressures.size(), sampled.fluid_positions.size());
  for (std::size_t i = 0; i < pressures.size(); ++i) EXPECT_EQ(std::isnan(pressures[i]), i == 3) << i;
}

TEST(Velocities, AreThoseOfTheParticlesById) {
  const Scene scene = tank_of_water();
  SampledScene sampled = sample_scene(scene, kSpacing).value();
  sampled.fluid_positions[3] = {1e6f, 0.0f, 0.0f};
  World world(scene, sampled, make_plan(scene, kSpacing), WorldOptions{1, Backend::kCpu});
  Snapshot before;
  Snapshot after;
  for (int i = 0; i < 5; ++i) world.step({});
  world.fill(before);
  world.step({});
  world.fill(after);
  std::vector<glm::vec3> velocities;
  world.fill_velocities(velocities);
  ASSERT_EQ(velocities.size(), sampled.fluid_positions.size());
  const float dt = static_cast<float>(world.plan().time_step);
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    if (i == 3) {
      EXPECT_TRUE(std::isnan(velocities[i].x));
      continue;
    }
    // Leap-frog: the velocity is what took it from the one place to the other, to the rounding of places.
    const glm::vec3 moved = (after.positions[i] - before.positions[i]) / dt;
    EXPECT_LT(glm::distance(velocities[i], moved), 1e-3f) << i;
  }
}

TEST(Instruments, MoveWithTheirBody) {
  Scene scene = tank_of_water();
  const SampledScene sampled = sample_scene(scene, kSpacing).value();
  scene.bodies[0].pose.position.x += 0.05;  // the tank goes, the water stays
  World world(scene, sampled, make_plan(scene, kSpacing), WorldOptions{1, Backend::kCpu});
  Instruments instruments(scene, sampled);
  const Measurement& m = instruments.measure(world);
  const double whole = static_cast<double>(sampled.fluid_positions.size()) * 1e-3;
  EXPECT_NEAR(m.masses[1], 0.25 * whole, 0.01 * whole) << "a quarter of the water is right of x = 0.05";
}

TEST(Instruments, CountWhatIsInsideSolids) {
  Scene scene = tank_of_water();
  const SampledScene sampled = sample_scene(scene, kSpacing).value();
  scene.bodies[0].pose.position.y += 0.02;  // the floor rises into two layers
  World world(scene, sampled, make_plan(scene, kSpacing), WorldOptions{1, Backend::kCpu});
  Instruments instruments(scene, sampled);
  const Measurement& m = instruments.measure(world);
  std::size_t below = 0;
  for (const glm::vec3& p : sampled.fluid_positions) below += p.y < 0.02f ? 1 : 0;
  EXPECT_GT(below, 100u);
  EXPECT_EQ(m.in_solids, below);
  ASSERT_EQ(m.in_body.size(), 1u);
  EXPECT_EQ(m.in_body[0], below);
}

TEST(Instruments, ChangeNothing) {
  const Scene measured = tank_of_water();
  Scene plain = measured;
  plain.gauges.clear();
  plain.regions.clear();
  const SampledScene sampled = sample_scene(measured, kSpacing).value();
  World a(measured, sampled, make_plan(measured, kSpacing), WorldOptions{1, Backend::kCpu});
  World b(plain, sample_scene(plain, kSpacing).value(), make_plan(plain, kSpacing),
          WorldOptions{1, Backend::kCpu});
  Instruments instruments(measured, sampled);
  for (int i = 0; i < 10; ++i) {
    a.step({});
    (void)instruments.measure(a);
    b.step({});
  }
  EXPECT_EQ(a.hash(), b.hash());
}

}  // namespace
}  // namespace slosh
