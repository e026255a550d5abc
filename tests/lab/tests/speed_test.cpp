// What `slosh report speed` works out: rates, least traffic, roofs; and that its pools are what it says.
#include "tests/lab/report/speed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace slosh::report {
namespace {

SpeedRow speed_row() {
  return {.figure = "6b",
          .backend = "cpu",
          .device = "a CPU, 2 threads",
          .fluid_particles = 32000,
          .body_particles = 100,
          .wall_particles = 5000,
          .bodies = 1,
          .spacing = 0.02,
          .step_ms = 16.0,
          .step_p10_ms = 15.5,
          .step_p90_ms = 17.0,
          .picture_ms = 80.0,
          .time_step = 0.004,
          .sub_steps = 2};
}

TEST(Speed, RatesAreOfAStep) {
  EXPECT_DOUBLE_EQ(speed_row().particle_steps_per_s(), 2e6);
  EXPECT_DOUBLE_EQ(speed_row().real_time_factor(), 0.25);
}

TEST(Speed, TheRoofIsTheLowerCeiling) {
  const Ceilings ceilings{10e9, 100e9};
  EXPECT_DOUBLE_EQ(roof(ceilings, 2.0), 20e9);
  EXPECT_DOUBLE_EQ(roof(ceilings, 50.0), 100e9);
  RoofRow row{"", 0, "", 1.0, {}, 5e6, 10e6, ceilings};
  EXPECT_DOUBLE_EQ(row.share_of_roof(), 0.5);  // 10 of the 20 GFLOP/s that 2 FLOP a byte allow
  row.flops = 0.0;
  EXPECT_DOUBLE_EQ(row.share_of_roof(), 0.5);  // 5 of 10 GB/s
}

TEST(Speed, PairsAreCountedAcrossCells) {
  const std::vector<glm::vec3> row{{0.0f, 0.0f, 0.0f}, {0.5f, 0.0f, 0.0f}, {1.5f, 0.0f, 0.0f}};
  const PairCounts counts = count_pairs(row, 1.01);
  EXPECT_DOUBLE_EQ(counts.candidates, 3.0);
  EXPECT_DOUBLE_EQ(counts.neighbours, 4.0 / 3.0);
}

/// Counted by hand from the columns' table: 33 bytes are carried, 29 of them are no id.
TEST(Speed, TrafficIsEachColumnOnce) {
  Plan plan;
  const PairCounts pairs{200.0, 30.0};
  const std::vector<PassWork> cpu = pass_work(plan, pairs, Backend::kCpu);
  ASSERT_EQ(cpu.size(), 3u);
  EXPECT_EQ(cpu[0].pass, PassId::kSortFluid);
  EXPECT_DOUBLE_EQ(cpu[0].bytes, 2 * 33 + 16);
  EXPECT_DOUBLE_EQ(cpu[0].flops, 0.0);
  EXPECT_DOUBLE_EQ(cpu[1].bytes, 29 + 4 + 40 + 8 * 30);
  EXPECT_DOUBLE_EQ(cpu[1].flops, 8 * 200 + 44 * 30);
  EXPECT_DOUBLE_EQ(cpu[2].bytes, 29 + 40 + 12 + 8 * 30);
  EXPECT_DOUBLE_EQ(cpu[2].flops, 24 * 30);
  EXPECT_DOUBLE_EQ(pass_work(plan, pairs, Backend::kCuda)[2].bytes, 29 + 40 + 12 + 4 * 30);
  plan.runs.set(PassId::kOneViscosity, true);
  EXPECT_DOUBLE_EQ(pass_work(plan, pairs, Backend::kCpu)[2].flops, (24 + 45) * 30);
}

TEST(Speed, PoolsKeepTheirTotal) {
  for (const int spheres : {0, 1, 4}) {
    const std::size_t on_spheres = spheres > 0 ? 400 : 0;
    const SpeedPool pool = speed_pool(2000, on_spheres, spheres);
    EXPECT_EQ(pool.sampled.fluid_positions.size() + pool.body_particles, 2000u) << spheres;
    EXPECT_NEAR(static_cast<double>(pool.body_particles), static_cast<double>(on_spheres), 60.0) << spheres;
    ASSERT_EQ(pool.scene.bodies.size(), 1u + static_cast<std::size_t>(spheres));
    // Spheres do not touch: their surface particles stay more than a spacing apart.
    for (std::size_t a = 1; a < pool.scene.bodies.size(); ++a) {
      EXPECT_EQ(pool.scene.bodies[a].motion, BodyMotion::kFree);
      for (std::size_t b = a + 1; b < pool.scene.bodies.size(); ++b) {
        float nearest = 1e9f;
        for (const glm::vec3& x : pool.sampled.surfaces[a].positions) {
          for (const glm::vec3& y : pool.sampled.surfaces[b].positions)
            nearest = std::min(nearest, glm::distance(x + glm::vec3(pool.scene.bodies[a].pose.position),
                                                      y + glm::vec3(pool.scene.bodies[b].pose.position)));
        }
        EXPECT_GT(nearest, pool.sampled.spacing);
      }
    }
  }
}

TEST(Speed, RowsAreReadAsTheyWereWritten) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "speed_rows_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "speed.csv") << kSpeedHeader << '\n' << csv_line(speed_row()) << '\n';
  const ShareRow share{"6c", "a CPU", 32000, 4, "density", 6.0, 0.4};
  std::ofstream(folder / "shares.csv") << kShareHeader << '\n' << csv_line(share) << '\n';
  const RoofRow roof_row{"a CPU", 32000, "density", 6.0, {200.0, 30.0}, 9e6, 9e7, {1e10, 1e11}};
  std::ofstream(folder / "roofline.csv") << kRoofHeader << '\n' << csv_line(roof_row) << '\n';
  SpeedRows rows;
  const Result<bool> read = read_speeds(folder / "speed.csv", rows);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(rows.speeds.size(), 1u);
  EXPECT_EQ(csv_line(rows.speeds[0]), csv_line(speed_row()));
  ASSERT_EQ(rows.shares.size(), 1u);
  EXPECT_EQ(csv_line(rows.shares[0]), csv_line(share));
  ASSERT_EQ(rows.roofs.size(), 1u);
  EXPECT_EQ(csv_line(rows.roofs[0]), csv_line(roof_row));
}

TEST(Speed, CeilingsAreMeasured) {
  const Ceilings found = cpu_ceilings(1, 8);
  EXPECT_GT(found.bytes_per_s, 1e8);
  EXPECT_GT(found.flops_per_s, 1e9);
}

}  // namespace
}  // namespace slosh::report
