#include "sim/plan.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "scenes/load.h"
#include "tests/support/places.h"
#include "tests/support/tank.h"

namespace slosh {
namespace {

using testing::make_tank;

bool has(const std::vector<Pass>& passes, const std::string& name) {
  for (const Pass& pass : passes) {
    if (pass.name == name) return true;
  }
  return false;
}

class GoldenPlan : public ::testing::TestWithParam<const char*> {};

// SLOSH_UPDATE_GOLDEN=1 writes what is seen; look at the difference before committing it.
TEST_P(GoldenPlan, IsAsCommitted) {
  const auto file = find_scene(GetParam());
  ASSERT_TRUE(file) << file.error().text();
  const auto scene = load_scene(file.value());
  ASSERT_TRUE(scene) << scene.error().text();
  const std::string seen = describe(make_plan(scene.value(), scene.value().spacing_max));
  const std::filesystem::path golden = test::source_dir() / "tests/sim/golden" / (GetParam() + std::string(".plan"));
  if (std::getenv("SLOSH_UPDATE_GOLDEN")) std::ofstream(golden) << seen;
  std::ifstream stream(golden);
  ASSERT_TRUE(stream) << golden;
  std::stringstream expected;
  expected << stream.rdbuf();
  EXPECT_EQ(seen, expected.str());
}

INSTANTIATE_TEST_SUITE_P(Shipped, GoldenPlan,
                         ::testing::Values("bucket", "spoon", "pour", "spin", "pool", "probe"));

TEST(Plan, LeavesOutWhatAFixedTankDoesNotNeed) {
  auto tank = make_tank({});
  tank.scene.bodies[0].measured = false;
  const Plan plan = make_plan(tank.scene, 0.01);
  EXPECT_FALSE(plan.body_wrench);
  EXPECT_FALSE(plan.rigid_dynamics);
  EXPECT_FALSE(plan.couplings);
  EXPECT_FALSE(plan.contacts);
  EXPECT_TRUE(has(plan.left_out, "wrench on bodies"));
  EXPECT_TRUE(has(plan.left_out, "move bodies"));
}

TEST(Plan, TakesOneViscosityWhereThereIsOne) {
  auto tank = make_tank({});
  EXPECT_TRUE(make_plan(tank.scene, 0.01).one_viscosity);
  tank.scene.fluids[0].dynamic_viscosity = 0.0;
  EXPECT_FALSE(make_plan(tank.scene, 0.01).viscosity);
  tank.scene.bodies[0].dynamic_viscosity = 5.0;
  EXPECT_TRUE(make_plan(tank.scene, 0.01).viscosity);
}

TEST(Plan, ShortensTheStepWithSpacingViscosityAndStiffness) {
  auto tank = make_tank({});
  const double normal = make_plan(tank.scene, 0.01).time_step;
  EXPECT_NEAR(make_plan(tank.scene, 0.005).time_step, 0.5 * normal, 1e-9);
  tank.scene.stiffness = 400.0;
  EXPECT_LT(make_plan(tank.scene, 0.01).time_step, normal);
  tank.scene.stiffness = 0.0;
  tank.scene.fluids[0].dynamic_viscosity = 100.0;
  const Plan thick = make_plan(tank.scene, 0.01);
  EXPECT_LT(thick.time_step, 0.2 * normal);
  EXPECT_NE(thick.time_step_reason.find("viscosity"), std::string::npos);
}

TEST(Plan, WithoutFluidThereAreNoParticlePasses) {
  Scene scene;
  Body body;
  body.name = "brick";
  body.motion = BodyMotion::kFree;
  body.mass.mass = 1.0;
  body.mesh = 0;
  scene.meshes.push_back(testing::box_mesh(glm::dvec3(-0.05), glm::dvec3(0.05)));
  scene.bodies.push_back(body);
  const Plan plan = make_plan(scene, 0.01);
  EXPECT_FALSE(plan.has_fluid);
  EXPECT_TRUE(plan.rigid_dynamics);
  EXPECT_FALSE(has(plan.passes, "density"));
}

}  // namespace
}  // namespace slosh
