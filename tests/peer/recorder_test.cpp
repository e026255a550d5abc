#include "peer/output/recorder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "peer/haptics/script_device.h"
#include "peer/output/plot.h"
#include "servo_kit.h"

namespace slosh {
namespace {

std::filesystem::path folder(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / ("recorder_" + name);
  std::filesystem::create_directories(path);
  return path;
}

void run(test::ServoKit& kit, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    kit.publish(0.001 * i);
    kit.device->next.pose.position.x = 1e-5 * i;
    kit.tick(0.001 * i);
  }
}

TEST(Recorder, WritesWhatWasFeltAndWhereTheHandleWas) {
  const std::filesystem::path out = folder("writes");
  test::ServoKit kit;
  Result<std::unique_ptr<Recorder>> recorder = Recorder::start(*kit.servo, out);
  ASSERT_TRUE(recorder) << recorder.error().text();
  run(kit, 1000);
  recorder.value()->stop();
  EXPECT_NEAR(static_cast<double>(recorder.value()->rows()), 500.0, 1.0);
  EXPECT_NEAR(recorder.value()->peaks()[0].force, 9.98, 0.02) << "1000 N/m, 9.98 mm";

  const Result<std::vector<WrenchSeries>> felt = read_wrenches(out / "wrenches.csv");
  ASSERT_TRUE(felt) << felt.error().text();
  EXPECT_EQ(felt.value()[0].time.size(), recorder.value()->rows());
  const Result<std::vector<PoseKey>> poses = read_poses(out / "poses.csv", 0);
  ASSERT_TRUE(poses) << poses.error().text();
  EXPECT_EQ(poses.value().size(), recorder.value()->rows());
  EXPECT_NEAR(poses.value().back().pose.position.x, 0.00998, 2e-5);
}

TEST(Recorder, WhatIsDrainedIsOnDiskBeforeTheEnd) {
  const std::filesystem::path out = folder("early");
  test::ServoKit kit;
  Result<std::unique_ptr<Recorder>> recorder = Recorder::start(*kit.servo, out);
  ASSERT_TRUE(recorder);
  run(kit, 1000);
  // The recorder is still running: wait until its thread has come round, however slow the machine is.
  std::size_t rows = 0;
  while (rows < 400) {
    const Result<std::vector<WrenchSeries>> felt = read_wrenches(out / "wrenches.csv");
    if (felt && !felt.value().empty()) rows = felt.value()[0].time.size();
    std::this_thread::yield();
  }
  EXPECT_GE(rows, 400u);
}

TEST(Recorder, AFolderThatIsNotThereIsAnError) {
  test::ServoKit kit;
  const Result<std::unique_ptr<Recorder>> recorder = Recorder::start(*kit.servo, "/nowhere/at/all");
  ASSERT_FALSE(recorder);
  EXPECT_NE(recorder.error().where.find("wrenches.csv"), std::string::npos);
}

}  // namespace
}  // namespace slosh
