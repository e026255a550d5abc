#include "sim/plan.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "scenes/load.h"
#include "sim/passes/pass.h"
#include "sim/world.h"
#include "tests/support/places.h"
#include "tests/support/tank.h"

namespace slosh {
namespace {

using testing::make_tank;

bool has(const std::vector<Pass>& passes, PassId id) {
  for (const Pass& pass : passes) {
    if (pass.id == id) return true;
  }
  return false;
}

// What a plan decides, without its prose.
std::string decisions(const Plan& plan) {
  std::ostringstream text;
  text << "model " << name(plan.model) << '\n'
       << "support_radius_mm " << plan.support_radius * 1e3 << '\n'
       << "stiffness_m2_s2 " << plan.stiffness << '\n'
       << "time_step_ms " << plan.time_step * 1e3 << '\n'
       << "sub_steps " << plan.sub_steps << '\n';
  for (const Pass& pass : plan.passes) text << "runs " << name(pass.id) << '\n';
  for (const Pass& pass : plan.left_out) text << "left_out " << name(pass.id) << '\n';
  return text.str();
}

// Against the committed one. SLOSH_UPDATE_GOLDEN=1 writes what is seen; look at the difference before
// committing it.
void expect_as_committed(const std::string& name, const Scene& scene) {
  const std::string seen = decisions(make_plan(scene, scene.spacing_max));
  const std::filesystem::path golden = test::source_dir() / "tests/sim/golden" / (name + ".plan");
  if (std::getenv("SLOSH_UPDATE_GOLDEN")) std::ofstream(golden) << seen;
  std::ifstream stream(golden);
  ASSERT_TRUE(stream) << golden;
  std::stringstream expected;
  expected << stream.rdbuf();
  EXPECT_EQ(seen, expected.str());
}

class GoldenPlan : public ::testing::TestWithParam<const char*> {};

TEST_P(GoldenPlan, IsAsCommitted) {
  const auto file = find_scene(GetParam());
  ASSERT_TRUE(file) << file.error().text();
  const auto scene = load_scene(file.value());
  ASSERT_TRUE(scene) << scene.error().text();
  expect_as_committed(GetParam(), scene.value());
}

TEST_P(GoldenPlan, OfTheIncompressibleModelIsAsCommitted) {
  const auto file = find_scene(GetParam());
  ASSERT_TRUE(file) << file.error().text();
  auto scene = load_scene(file.value());
  ASSERT_TRUE(scene) << scene.error().text();
  scene.value().model = ParticleModel::kIncompressible;
  expect_as_committed(GetParam() + std::string("_incompressible"), scene.value());
}

INSTANTIATE_TEST_SUITE_P(Shipped, GoldenPlan,
                         ::testing::Values("bucket", "spoon", "pour", "spin", "pool", "probe", "crepe",
                                           "mixer", "vessel"));

// sim/PASSES.md as the table of passes has it; SLOSH_UPDATE_GOLDEN=1 writes it.
TEST(Passes, ThePageIsTheTable) {
  std::ostringstream page;
  page << "# The passes of a sub-step\n\n"
          "Written from `passes/list.h` and each folder's `pass.cpp` (`SLOSH_UPDATE_GOLDEN=1 test_sim "
          "--gtest_filter=Passes.*`).\nIn the order in which they run. *In*: the pass whose loop over the "
          "neighbours "
          "does it.\n\n| id | what | reads | writes | in |\n|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < kPassCount; ++i) {
    const PassId id = static_cast<PassId>(i);
    const PassEntry& pass = entry(id);
    page << "| `" << name(id) << "` | " << pass.words << " | " << pass.reads << " | " << pass.writes << " | "
         << (runs_in(id) == id ? std::string("–") : "`" + std::string(name(runs_in(id))) + "`") << " |\n";
    EXPECT_TRUE(std::filesystem::exists(test::source_dir() / "sim/passes" / name(id) / "pass.cpp"))
        << name(id);
  }
  const std::filesystem::path file = test::source_dir() / "sim/PASSES.md";
  if (std::getenv("SLOSH_UPDATE_GOLDEN")) std::ofstream(file) << page.str();
  std::stringstream committed;
  committed << std::ifstream(file).rdbuf();
  EXPECT_EQ(page.str(), committed.str());
}

// A pass is either run or left out, and the prose has a line for each.
TEST(Plan, DescribesEveryPassOnce) {
  for (const double viscosity : {0.0, 0.05}) {
    const Plan plan = make_plan(make_tank({.viscosity = viscosity}).scene, 0.01);
    ASSERT_EQ(plan.passes.size() + plan.left_out.size(), kPassCount);
    for (const Pass& pass : plan.passes) EXPECT_TRUE(plan.has(pass.id)) << name(pass.id);
    for (const Pass& pass : plan.left_out) EXPECT_FALSE(plan.has(pass.id)) << name(pass.id);
    const std::string text = describe(plan);
    for (const auto& list : {plan.passes, plan.left_out}) {
      for (const Pass& pass : list) EXPECT_NE(text.find(pass.reason), std::string::npos) << name(pass.id);
    }
  }
}

TEST(Plan, LeavesOutWhatAFixedTankDoesNotNeed) {
  auto tank = make_tank({});
  tank.scene.bodies[0].measured = false;
  const Plan plan = make_plan(tank.scene, 0.01);
  EXPECT_FALSE(plan.has(PassId::kWrenches));
  EXPECT_FALSE(plan.has(PassId::kMoveBodies));
  EXPECT_FALSE(plan.has(PassId::kCouplings));
  EXPECT_FALSE(plan.has(PassId::kContacts));
  EXPECT_TRUE(has(plan.left_out, PassId::kWrenches));
  EXPECT_TRUE(has(plan.left_out, PassId::kMoveBodies));
}

TEST(Plan, TakesOneViscosityWhereThereIsOne) {
  auto tank = make_tank({});
  EXPECT_TRUE(make_plan(tank.scene, 0.01).has(PassId::kOneViscosity));
  tank.scene.fluids[0].dynamic_viscosity = 0.0;
  EXPECT_FALSE(make_plan(tank.scene, 0.01).viscous());
  tank.scene.bodies[0].dynamic_viscosity = 5.0;
  EXPECT_TRUE(make_plan(tank.scene, 0.01).viscous());
}

TEST(Plan, ShortensTheStepWithSpacingViscosityAndStiffness) {
  auto tank = make_tank({});
  const double normal = make_plan(tank.scene, 0.01).time_step;
  EXPECT_NEAR(make_plan(tank.scene, 0.005).time_step, 0.5 * normal, 1e-9);
  tank.scene.stiffness = 400.0;
  EXPECT_LT(make_plan(tank.scene, 0.01).time_step, normal);
  tank.scene.stiffness = 0.0;
  tank.scene.fluids[0].dynamic_viscosity = 100.0;
  const Plan thick = make_plan(tank.scene, 0.01, false);
  EXPECT_LT(thick.time_step, 0.2 * normal);
  EXPECT_NE(thick.time_step_reason.find("viscosity"), std::string::npos);
}

// Implicit where it is worth it, and nowhere else.
TEST(Plan, SolvesDragWhereExplicitStepsWouldBeManyTimesShorter) {
  auto tank = make_tank({});
  const Plan thin = make_plan(tank.scene, 0.01);
  EXPECT_FALSE(thin.implicit_viscosity);
  tank.scene.fluids[0].dynamic_viscosity = 100.0;
  const Plan solved = make_plan(tank.scene, 0.01), without = make_plan(tank.scene, 0.01, false);
  EXPECT_TRUE(solved.has(PassId::kImplicitViscosity));
  EXPECT_FALSE(solved.has(PassId::kBodyDrag));
  EXPECT_FALSE(solved.explicit_viscosity());
  EXPECT_NEAR(solved.time_step, thin.time_step, 1e-9) << solved.time_step_reason;
  EXPECT_FALSE(without.has(PassId::kImplicitViscosity));
  EXPECT_LT(without.time_step, 0.25 * solved.time_step);
  tank.scene.model = ParticleModel::kPaper;
  EXPECT_FALSE(make_plan(tank.scene, 0.01).implicit_viscosity);
}

// From twice the step on, and not before; at a wide support from four times.
TEST(Plan, SolvesDragFromTwiceTheStepOn) {
  for (const auto& [support_ratio, from] : {std::pair{2.0, 2.0}, {2.5, 4.0}}) {
    auto tank = make_tank({});
    tank.scene.support_ratio = support_ratio;
    const double longest = make_plan(tank.scene, 0.01).time_step;
    int stepped = 0, solved = 0;
    for (double viscosity = 1.0; viscosity < 200.0; viscosity *= 1.05) {
      tank.scene.fluids[0].dynamic_viscosity = viscosity;
      const double times = longest / make_plan(tank.scene, 0.01, false).time_step;
      if (std::abs(times - from) < 0.02) continue;
      EXPECT_EQ(make_plan(tank.scene, 0.01).implicit_viscosity, times > from)
          << viscosity << " Pa·s, " << times << " times";
      stepped += times > 0.75 * from && times < from;
      solved += times > from && times < 1.25 * from;
    }
    EXPECT_GT(stepped, 2);
    EXPECT_GT(solved, 2);
  }
}

// 10⁶ Pa·s at 1 cm is an explicit step of some 10 ns: refused with what would do; 1000 Pa·s runs.
TEST(Plan, ThatWouldNotComeToAnEndIsRefused) {
  auto tank = make_tank({});
  tank.scene.fluids[0].dynamic_viscosity = 1e6;
  const Plan endless = make_plan(tank.scene, 0.01, false);
  ASSERT_LT(endless.time_step, 1e-7);
  const auto world = make_world(tank.scene, tank.sampled, endless, {1, Backend::kCpu});
  ASSERT_FALSE(world);
  EXPECT_NE(world.error().what.find("explicit viscosity of 1e+06 Pa·s"), std::string::npos)
      << world.error().text();
  double most = 0.0;
  ASSERT_EQ(std::sscanf(world.error().mend.c_str(), "Up to %lf Pa·s", &most), 1) << world.error().text();
  EXPECT_GT(most, 2000.0);
  // What it says will do does.
  tank.scene.fluids[0].dynamic_viscosity = 0.99 * most;
  EXPECT_TRUE(make_world(tank.scene, tank.sampled, make_plan(tank.scene, 0.01, false), {1, Backend::kCpu}));
  tank.scene.fluids[0].dynamic_viscosity = 1000.0;
  EXPECT_TRUE(make_world(tank.scene, tank.sampled, make_plan(tank.scene, 0.01, false), {1, Backend::kCpu}));
  // Solved it runs; a thousand times as much does not.
  tank.scene.fluids[0].dynamic_viscosity = 1e6;
  EXPECT_TRUE(make_world(tank.scene, tank.sampled, make_plan(tank.scene, 0.01), {1, Backend::kCpu}));
  tank.scene.fluids[0].dynamic_viscosity = 1e9;
  EXPECT_FALSE(make_world(tank.scene, tank.sampled, make_plan(tank.scene, 0.01), {1, Backend::kCpu}));
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
  EXPECT_FALSE(plan.has_fluid());
  EXPECT_TRUE(plan.has(PassId::kMoveBodies));
  EXPECT_FALSE(has(plan.passes, PassId::kDensity));
}

}  // namespace
}  // namespace slosh
