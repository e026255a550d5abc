// poses.csv: what is read, and what is refused with its line.
#include <gtest/gtest.h>

#include <fstream>

#include "peer/haptics/script_device.h"

namespace slosh {
namespace {

class ReplayTest : public ::testing::Test {
 protected:
  Result<std::vector<PoseKey>> read(const std::string& rows, int device = 0) {
    const std::filesystem::path file =
        std::filesystem::path(::testing::TempDir()) /
        (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + "_poses.csv");
    std::ofstream(file) << kPosesHeader << '\n' << rows;
    return read_poses(file, device);
  }
  void expect_error(const std::string& rows, const std::string& line, const std::string& what) {
    const Result<std::vector<PoseKey>> result = read(rows);
    ASSERT_FALSE(result) << rows;
    EXPECT_NE(result.error().where.find(line), std::string::npos) << result.error().text();
    EXPECT_NE(result.error().what.find(what), std::string::npos) << result.error().text();
  }
};

TEST_F(ReplayTest, ReadsTheRowsOfOneDevice) {
  const Result<std::vector<PoseKey>> keys =
      read("0,0,1,2,3,1,0,0,0\n0,1,9,9,9,1,0,0,0\r\n0.002,0,1.5,2,3,0,1,0,0\n\n");
  ASSERT_TRUE(keys) << keys.error().text();
  ASSERT_EQ(keys.value().size(), 2u);
  EXPECT_EQ(keys.value()[1].time, 0.002);
  EXPECT_EQ(keys.value()[1].pose.position.x, 1.5);
  EXPECT_EQ(keys.value()[1].pose.orientation.x, 1.0);
}

TEST_F(ReplayTest, NamesTheLineOfEachMistake) {
  expect_error("0,0,1,2,3,1,0,0,0\n0.1,0,nan,2,3,1,0,0,0\n", "line 3", "x_m is 'nan'");
  expect_error("0,0,1,2,inf,1,0,0,0\n", "line 2", "z_m");
  expect_error("0,0,1,2,3,1,0,0\n", "line 2", "8 fields");
  expect_error("0,0,1,2,3,1,0,0,0,0\n", "line 2", "more than 9");
  expect_error("0,0,1,2,three,1,0,0,0\n", "line 2", "'three'");
  expect_error("0,0,1,2,,1,0,0,0\n", "line 2", "z_m is ''");
  expect_error("0,0,1,2,3,0.5,0,0,0\n", "line 2", "length 0.5");
  expect_error("0,0,1,2,3,1,0,0,0\n\n0,0,1,2,3,1,0,0,0\n", "line 4", "does not rise");
  expect_error("0,-1,1,2,3,1,0,0,0\n", "line 2", "device");
  expect_error("0,0.5,1,2,3,1,0,0,0\n", "line 2", "device");
  expect_error("0,1,1,2,3,1,0,0,0\n", "poses.csv", "no line for device 0");
}

TEST_F(ReplayTest, RefusesAnotherHeaderAndAMissingFile) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "header_poses.csv";
  std::ofstream(file) << "time,device\n";
  const Result<std::vector<PoseKey>> wrong = read_poses(file, 0);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().where.find("line 1"), std::string::npos);
  EXPECT_FALSE(read_poses("/nowhere/poses.csv", 0));
}

}  // namespace
}  // namespace slosh
