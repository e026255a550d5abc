// What is told of a run before it takes long.
#include "peer/app/time_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scenes/make/solid.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kSpacing = 0.012;

Scene tank(double viscosity) {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  b.add_fixed("tank", lab::tank_at_floor({0.12, 0.12, 0.12}, 0.03));
  b.add_volume(make::box({-0.06, 0.0, -0.06}, {0.06, 0.06, 0.06}));
  b.set_domain({-1.0, -0.5, -1.0}, {1.0, 1.0, 1.0});
  return b.scene;
}

World world_of(const Scene& scene) {
  return World(scene, sample_scene(scene, kSpacing).value(), make_plan(scene, kSpacing, false),
               WorldOptions{1, Backend::kCpu});
}

TEST(TimeEstimate, IsStepsTimesTheirCost) {
  const PlannedTime planned{1.0, 10.0, true, false};
  const TimeEstimate quick = estimate_time(planned, 0.002, 0.001);
  EXPECT_NEAR(quick.settle, 0.5, 1e-12) << "settling is not paced";
  EXPECT_NEAR(quick.run, 10.0, 1e-12) << "a paced run takes its time";
  EXPECT_NEAR(quick.pace, 1.0, 1e-12);
  const TimeEstimate slow = estimate_time(planned, 2e-6, 0.001);
  EXPECT_NEAR(slow.settle, 500.0, 1e-9);
  EXPECT_NEAR(slow.run, 5000.0, 1e-9);
  EXPECT_NEAR(slow.pace, 0.002, 1e-12);
  EXPECT_NEAR(estimate_time({1.0, 10.0, false, false}, 0.002, 0.001).run, 5.0, 1e-12);
  EXPECT_EQ(estimate_time({1.0, std::numeric_limits<double>::infinity(), true, false}, 0.002, 0.001).run,
            0.0);
}

TEST(TimeEstimate, SaysStepsCauseAndTime) {
  const Scene scene = tank(1000.0);
  const PlannedTime planned{1.0, 10.0, true, false};
  const Plan plan = make_plan(scene, kSpacing, false);
  const std::string words = in_words(estimate_time(planned, plan.time_step, 0.05), planned, plan);
  for (const char* part :
       {"steps of", "explicit viscosity of 1e+03 Pa·s", "50 ms", "to settle", "for the run"})
    EXPECT_NE(words.find(part), std::string::npos) << part << " in " << words;
}

TEST(TimeEstimate, ARunOfMoreThanADayIsRefusedUnlessAgreed) {
  const Scene scene = tank(3000.0);
  World world = world_of(scene);
  const std::uint64_t before = world.hash();
  Progress progress(false, 1e9);
  const PlannedTime endless{1.0, 1e6, true, false};
  testing::internal::CaptureStderr();
  const Result<bool> refused = agree_on_time(world, {}, endless, progress);
  ASSERT_FALSE(refused);
  for (const char* part : {"too long", "steps of", "explicit viscosity", "--yes", "--spacing"})
    EXPECT_NE(refused.error().text().find(part), std::string::npos)
        << part << " in " << refused.error().text();
  PlannedTime agreed = endless;
  agreed.agreed = true;
  EXPECT_TRUE(agree_on_time(world, {}, agreed, progress));
  EXPECT_NE(testing::internal::GetCapturedStderr().find("slow: "), std::string::npos) << "but told";
  EXPECT_EQ(world.hash(), before) << "the steps that were timed are taken back";
  EXPECT_EQ(world.tick(), 0u);
}

TEST(TimeEstimate, SaysNothingOfAQuickRun) {
  const Scene scene = tank(0.05);
  World world = world_of(scene);
  Progress progress(false, 1e9);
  testing::internal::CaptureStderr();
  EXPECT_TRUE(agree_on_time(world, {}, {1.0, 10.0, true, false}, progress));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace slosh
