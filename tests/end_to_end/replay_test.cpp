// `slosh play --record` and `slosh replay` from the command line to their files.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "process.h"
#include "tests/support/contains.h"

namespace slosh {
namespace {

using test::contains;
using test::Outcome;

TEST(ReplayVerb, ARecordedRunComesOutTheSameAndIsFilmed) {
  std::filesystem::remove_all(test::test_folder());
  const Outcome played = test::slosh({"play", "bucket", "--no-render", "--seconds", "1", "--spacing", "0.012",
                                      "--out", "out", "--record", "bucket.rec", "--backend", "cpu"});
  ASSERT_EQ(played.code, 0) << played.err;
  EXPECT_TRUE(contains(played.out, "bucket.rec")) << played.out;
  const Outcome again =
      test::slosh({"replay", "bucket.rec", "--out", "again", "--size", "160x120", "--fps", "5"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(contains(again.out, "hashes agree")) << again.out;
  for (const char* file : {"view.mp4", "final.png", "wrenches.csv", "wrenches.png", "summary.json"}) {
    EXPECT_GT(std::filesystem::file_size(test::test_folder() / "again" / file), 0u) << file;
  }
  EXPECT_TRUE(contains(test::read_text(test::test_folder() / "again" / "summary.json"), "hashes agree"));

  // Cut off, it is replayed as far as it goes; without --out nothing is written.
  std::filesystem::resize_file(test::test_folder() / "bucket.rec",
                               std::filesystem::file_size(test::test_folder() / "bucket.rec") - 2000);
  const Outcome cut = test::slosh({"replay", "bucket.rec"});
  EXPECT_EQ(cut.code, 0) << cut.err;
  EXPECT_TRUE(contains(cut.out, "cut off")) << cut.out;
}

TEST(ReplayVerb, SaysWhatIsWrongWithAFile) {
  std::filesystem::create_directories(test::test_folder());
  std::ofstream(test::test_folder() / "text.rec") << "not a recording at all";
  const Outcome text = test::slosh({"replay", "text.rec"});
  EXPECT_EQ(text.code, 1);
  EXPECT_TRUE(contains(text.err, "text.rec")) << text.err;
  EXPECT_TRUE(contains(text.err, "not a recording")) << text.err;
  const Outcome none = test::slosh({"replay", "nowhere.rec"});
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(contains(none.err, "nowhere.rec")) << none.err;
  EXPECT_EQ(test::slosh({"replay"}).code, 2);
  const Outcome unwritable = test::slosh({"play", "probe", "--no-render", "--seconds", "0.1", "--spacing",
                                          "0.012", "--record", "/proc/nowhere/run.rec"});
  EXPECT_EQ(unwritable.code, 1);
  EXPECT_TRUE(contains(unwritable.err, "/proc/nowhere/run.rec")) << unwritable.err;
}

}  // namespace
}  // namespace slosh
