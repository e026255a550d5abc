// What is forced in changes nothing that matters, and the planned step is the first row.
#include "tests/lab/report/passes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/passes/pass.h"
#include "tests/lab/report/scene_builder.h"

namespace slosh::report {
namespace {

Scene tank(double viscosity) {
  SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  b.add_fixed("tank", tank_at_floor({0.1, 0.16, 0.1}, 0.04));
  b.scene.bodies[0].measured = false;
  b.add_volume(make::box({-0.05, 0.0, -0.05}, {0.05, 0.06, 0.05}));
  b.set_domain(glm::dvec3(-0.3), glm::dvec3(0.3));
  return b.scene;
}

PassTable table_of(const Scene& scene) {
  PassOptions options;
  options.steps = kComparedSteps;
  options.threads = 1;
  return measure_passes(scene, sample_scene(scene, 0.01).value(), options);
}

TEST(Passes, LeftOutOfAnInviscidTankAddNothingToIt) {
  const std::vector<PassRow> rows = table_of(tank(0.0)).rows;
  EXPECT_EQ(rows.front().what, "as planned");
  std::vector<std::string> names;
  for (const PassRow& row : rows) {
    names.push_back(row.what);
    EXPECT_GT(row.step_ms, 0.0);
    // Passes over bodies and viscosities of nothing give the same bits; none may move a particle.
    EXPECT_LT(row.off, 1e-6) << row.what;
  }
  for (const char* forced : {"with one_viscosity", "with pair_viscosity", "with wrenches", "with contacts"})
    EXPECT_NE(std::find(names.begin(), names.end(), forced), names.end()) << forced;
  const auto wrenches = std::find(names.begin(), names.end(), "with wrenches") - names.begin();
  EXPECT_TRUE(rows[static_cast<std::size_t>(wrenches)].same_bits);
}

/// Each pass that runs in a loop of its own has its time, a fused one is in another's, one left out has none.
TEST(Passes, SharesAreOfThoseThatRunAndMakeUpTheStep) {
  const PassTable table = table_of(tank(0.0));
  double sum = 0.0;
  std::vector<PassId> found;
  for (const PassShare& each : table.alone.shares) {
    EXPECT_GT(each.ms, 0.0);
    EXPECT_EQ(runs_in(each.pass), each.pass) << name(each.pass);
    sum += each.share;
    found.push_back(each.pass);
  }
  for (const PassId runs :
       {PassId::kSortFluid, PassId::kDensity, PassId::kPressureForce, PassId::kIntegrateFluid})
    EXPECT_NE(std::find(found.begin(), found.end(), runs), found.end()) << name(runs);
  EXPECT_EQ(std::find(found.begin(), found.end(), PassId::kWrenches), found.end());
  EXPECT_GT(sum, 0.5);
  EXPECT_LT(sum, 1.05);
}

TEST(Passes, AViscosityAParticleTakesItsMemory) {
  const std::vector<PassRow> rows = table_of(tank(0.05)).rows;
  const auto pair = std::find_if(rows.begin(), rows.end(),
                                 [](const PassRow& r) { return r.what == "with pair_viscosity"; });
  ASSERT_NE(pair, rows.end());
  EXPECT_EQ(pair->bytes_a_particle, rows.front().bytes_a_particle + sizeof(float));
  EXPECT_LT(pair->off, 1e-6);
}

}  // namespace
}  // namespace slosh::report
