#include "peer/output/run_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace slosh {
namespace {

namespace fs = std::filesystem;

class RunFolderTest : public ::testing::Test {
 protected:
  fs::path base_ = fs::path(::testing::TempDir()) / ("run_folder_" + std::to_string(getpid()));
  void SetUp() override { fs::remove_all(base_); }
  void TearDown() override { fs::remove_all(base_); }
  static void leave(const fs::path& file) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "earlier";
  }
};

TEST_F(RunFolderTest, IsMadeAndHeld) {
  const Result<RunFolder> first = RunFolder::take(base_ / "deep/out", false);
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_EQ(first.value().path(), base_ / "deep/out");
  EXPECT_TRUE(fs::is_directory(base_ / "deep/out"));
  const Result<RunFolder> second = RunFolder::take(base_ / "deep/out", false);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text().find("another run writes there now"), std::string::npos);
  EXPECT_FALSE(RunFolder::take(base_ / "deep/out", true)) << "nor may it be overwritten meanwhile";
}

TEST_F(RunFolderTest, WhatStaysEmptyGoesAgain) {
  fs::create_directories(base_);
  {
    const Result<RunFolder> made = RunFolder::take(base_ / "deep/out/", false);
    ASSERT_TRUE(made);
    const RunFolder copy = made.value();
  }
  EXPECT_FALSE(fs::exists(base_ / "deep"));
  EXPECT_TRUE(fs::exists(base_)) << "it was there before";
  { ASSERT_TRUE(RunFolder::take(base_, false)); }
  EXPECT_TRUE(fs::exists(base_)) << "empty, but not made here";
  {
    const Result<RunFolder> made = RunFolder::take_free(base_ / "deep/out");
    ASSERT_TRUE(made);
    leave(base_ / "deep/out/summary.json");
  }
  EXPECT_TRUE(fs::exists(base_ / "deep/out/summary.json"));
}

TEST_F(RunFolderTest, AnEarlierRunIsNotOverwrittenUnlessAsked) {
  for (const char* file :
       {"summary.json", "wrenches.csv", "poses.csv", "wrenches.png", "view.mp4", "final.png"}) {
    fs::remove_all(base_);
    leave(base_ / "out" / file);
    leave(base_ / "out/notes.txt");
    const Result<RunFolder> refused = RunFolder::take(base_ / "out", false);
    ASSERT_FALSE(refused) << file;
    EXPECT_NE(refused.error().text().find(file), std::string::npos) << refused.error().text();
    EXPECT_NE(refused.error().mend.find("--overwrite"), std::string::npos);
    EXPECT_TRUE(fs::exists(base_ / "out" / file));
    ASSERT_TRUE(RunFolder::take(base_ / "out", true));
    EXPECT_FALSE(fs::exists(base_ / "out" / file)) << "what is left of it must not pass for the new run's";
    EXPECT_TRUE(fs::exists(base_ / "out/notes.txt")) << "nothing else is touched";
  }
}

TEST_F(RunFolderTest, WithoutAWishTheNextFreeOneIsTaken) {
  {
    const Result<RunFolder> one = RunFolder::take_free(base_ / "bucket");
    ASSERT_TRUE(one);
    EXPECT_EQ(one.value().path(), base_ / "bucket");
    const Result<RunFolder> at_the_same_time = RunFolder::take_free(base_ / "bucket");
    ASSERT_TRUE(at_the_same_time);
    EXPECT_EQ(at_the_same_time.value().path(), base_ / "bucket-2");
  }
  EXPECT_EQ(RunFolder::take_free(base_ / "bucket").value().path(), base_ / "bucket")
      << "an empty one, of a run that was interrupted early, serves again";
  leave(base_ / "bucket/summary.json");
  leave(base_ / "bucket-2/wrenches.csv");
  EXPECT_EQ(RunFolder::take_free(base_ / "bucket").value().path(), base_ / "bucket-3");
}

TEST_F(RunFolderTest, WhatCannotBeAFolderIsAnError) {
  leave(base_ / "file");
  EXPECT_FALSE(RunFolder::take(base_ / "file", false));
  EXPECT_FALSE(RunFolder::take("/proc/nowhere", false));
  EXPECT_FALSE(RunFolder::take_free("/proc/nowhere"));
}

TEST(FolderName, StaysInItsPlaceWhateverSomebodyIsCalled) {
  EXPECT_EQ(folder_name("bucket", "scene"), "bucket");
  EXPECT_EQ(folder_name("my scene.v2", "scene"), "my-scene-v2");
  EXPECT_EQ(folder_name("../../etc", "scene"), "------etc");
  EXPECT_EQ(folder_name("/etc/passwd", "scene"), "-etc-passwd");
  EXPECT_EQ(folder_name("`touch x`|y$(z)", "scene"), "-touch-x--y--z-");
  for (const char* nothing : {"", ".", "..", "/", "~", "水", "\n", "-"})
    EXPECT_EQ(folder_name(nothing, "scene"), "scene") << nothing;
  EXPECT_EQ(folder_name(std::string(5000, 'a'), "scene").size(), 40u);
}

}  // namespace
}  // namespace slosh
