// What is refused is refused before anything is made or measured, leaves nothing behind and ends with a code
// that says so.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "process.h"
#include "tests/support/contains.h"

namespace slosh {
namespace {

using test::contains;
using test::Outcome;

class Refusals : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(test::test_folder());
    std::filesystem::create_directories(test::test_folder());
  }
  static bool there(const char* name) { return std::filesystem::exists(test::test_folder() / name); }
  static void write(const char* name, const std::string& text) {
    std::filesystem::create_directories((test::test_folder() / name).parent_path());
    std::ofstream(test::test_folder() / name) << text;
  }
};

TEST_F(Refusals, AFullFolderIsSaidBeforePassesAreMeasured) {
  write("full/passes.csv", "mine\n");
  const Outcome outcome = test::slosh({"report", "passes", "probe", "--quick", "--out", "full"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(contains(outcome.err, "holds an earlier report's passes.csv")) << outcome.err;
  EXPECT_TRUE(outcome.out.empty()) << "nothing was measured: " << outcome.out;
  EXPECT_EQ(test::read_text(test::test_folder() / "full" / "passes.csv"), "mine\n");
}

TEST_F(Refusals, ATableThatIsNoneLeavesNoFolder) {
  write("bad.csv", "not a report\n");
  for (const char* kind : {"error", "stability"}) {
    const Outcome outcome = test::slosh({"report", kind, "--from", "bad.csv", "--out", "drawn"});
    EXPECT_EQ(outcome.code, 1) << kind;
    EXPECT_TRUE(contains(outcome.err, "bad.csv")) << outcome.err;
    EXPECT_FALSE(there("drawn")) << kind;
  }
}

TEST_F(Refusals, AReportWhoseRunsWereAllRefusedHasFailed) {
  const Outcome outcome = test::slosh({"report", "error", "--quick", "--case", "stokes", "--model", "paper",
                                       "--spacing", "0.9", "--out", "refused"});
  EXPECT_EQ(outcome.code, 1) << outcome.err << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "every run was refused")) << outcome.err;
}

/// A library that cannot be loaded stands before the system's.
TEST_F(Refusals, WithoutOpenGLAFilmIsRefusedBeforeAnythingIsPrepared) {
  write("broken/libEGL.so.1", "");
  const std::vector<std::string> play{
      "env", "LD_LIBRARY_PATH=broken", test::program(), "play", "probe", "--headless", "--out", "out"};
  const Outcome outcome = test::Process(play, test::test_folder()).wait();
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "there is no libEGL.so.1")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "--no-render")) << outcome.err;
  EXPECT_FALSE(contains(outcome.err, "settling")) << outcome.err;
  EXPECT_FALSE(there("out"));
}

TEST_F(Refusals, AHeadsetWithoutAPictureIsNotPassedOver) {
  const Outcome outcome = test::slosh({"play", "probe", "--headless", "--vr", "--no-render", "--out", "out"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "--no-render excludes --vr")) << outcome.err;
  EXPECT_FALSE(there("out"));
}

TEST_F(Refusals, ARoomThatIsNotThereIsNotPassedOver) {
  const Outcome outcome =
      test::slosh({"play", "probe", "--headless", "--environment", "nowhere.hdr", "--out", "out"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(contains(outcome.err, "there is no file 'nowhere.hdr'")) << outcome.err;
  EXPECT_FALSE(there("out"));
}

TEST_F(Refusals, APlanWhoseStepCannotBeTakenHasFailed) {
  const Outcome outcome = test::slosh({"plan", "bucket", "--spacing", "0.3"});
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "a step: cannot be taken")) << outcome.err;
}

TEST_F(Refusals, AFlagTakesNoValue) {
  const Outcome outcome = test::slosh({"settings", "--new=3"});
  EXPECT_EQ(outcome.code, 2) << outcome.out;
}

TEST_F(Refusals, NameTheirSubject) {
  const Outcome outcome = test::slosh({"play", "probe", "--headless", "--no-render", "--device", "replay:"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(contains(outcome.err, "slosh: --device: 'replay:' names no file.")) << outcome.err;
}

/// No line is ended that nobody began, and no sentence twice.
TEST_F(Refusals, AreOneSentenceAndNoMore) {
  write("bucket.gltf", "{}");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"play", "buckett", "--headless"},
                                                {"replay", "nowhere.rec"},
                                                {"check", "buckett.gltf"},
                                                {"join", "slosh://nobody"}}) {
    const Outcome outcome = test::slosh(words);
    EXPECT_NE(outcome.code, 0) << words[0];
    EXPECT_FALSE(outcome.err.starts_with("\n")) << words[0];
    EXPECT_FALSE(contains(outcome.err, "\n\n")) << words[0] << ": " << outcome.err;
    EXPECT_FALSE(contains(outcome.err, "?.")) << words[0] << ": " << outcome.err;
  }
}

TEST_F(Refusals, WhoLooksOnIsOfferedNothingThatTheyAreRefused) {
  const std::string watch = test::slosh({"watch", "--help"}).out, join = test::slosh({"join", "--help"}).out;
  for (const char* word :
       {"--device", "take [GRIP]", "release [GRIP]", "pause, continue, reset", "set gravity"}) {
    EXPECT_FALSE(contains(watch, word)) << word;
    EXPECT_TRUE(contains(join, word)) << word;
  }
  for (const char* word : {"who ", "status ", "quit "}) EXPECT_TRUE(contains(watch, word)) << word;
}

}  // namespace
}  // namespace slosh
