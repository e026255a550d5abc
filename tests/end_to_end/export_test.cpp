// Frames for other programs, from the command line to an independent reader.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "process.h"
#include "tests/support/places.h"

namespace slosh {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::read_text;

class ExportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(test::test_folder());
    fs::create_directories(test::test_folder());
  }
  static fs::path at(const std::string& name) { return test::test_folder() / name; }
  /// A short run of the spoon's bowl, as fast as it goes.
  static std::vector<std::string> run(std::initializer_list<std::string> more) {
    std::vector<std::string> all{"play", "spoon",     "--headless", "--no-render", "--unpaced", "--spacing",
                                 "0.01", "--threads", "1",          "--seconds",   "0.11"};
    all.insert(all.end(), more);
    return all;
  }
  static const std::vector<std::string>& all_kinds() {
    static const std::vector<std::string> kinds{"particles:ply", "particles:vtu", "surface:ply",
                                                "surface:glb", "surface:vdb"};
    return kinds;
  }
};

TEST_F(ExportTest, EveryKindIsReadBackByAnotherProgram) {
  std::vector<std::string> arguments = run({"--out", "out", "--record", "run.rec", "--export-rate", "40"});
  for (const std::string& kind : all_kinds()) arguments.insert(arguments.end(), {"--export", kind});
  Outcome outcome = test::slosh(arguments);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("5 frames for other programs"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("frames/surface_*.vdb"), std::string::npos) << outcome.out;
  const nlohmann::json summary = nlohmann::json::parse(read_text(at("out/summary.json")));
  EXPECT_EQ(summary["export"]["frames"], 5);
  EXPECT_EQ(summary["export"]["left_out"], 0);

  const std::string reader = (test::source_dir() / "tests/end_to_end/read_frames.py").string();
  outcome =
      test::Process({"/usr/bin/python3", reader, "out/frames", "0.01", "40"}, test::test_folder()).wait();
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;

  // A replay writes the same to the byte.
  arguments = {"replay", "run.rec", "--out", "again", "--no-render", "--threads", "2", "--export-rate", "40"};
  for (const std::string kind : {"particles:ply", "surface:ply"})
    arguments.insert(arguments.end(), {"--export", kind});
  outcome = test::slosh(arguments);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file : {"frames.csv", "particles_00000.ply", "particles_00004.ply", "surface_00002.ply"}) {
    ASSERT_TRUE(fs::exists(at("again/frames") / file)) << file;
    EXPECT_TRUE(read_text(at("out/frames") / file) == read_text(at("again/frames") / file)) << file;
  }
}

TEST_F(ExportTest, WhatIsWrongIsSaidBeforeAnythingIsMeasured) {
  const struct {
    std::vector<std::string> arguments;
    int code;
    const char* words;
  } cases[] = {
      {run({"--export", "surface:obj"}), 2, "'surface:obj' is nothing that can be written"},
      {run({"--export", "particle:ply"}), 2, "Did you mean particles:ply?"},
      {run({"--export", "particles:ply", "--export-rate", "0"}), 2, "is not a number from 0.01 to 10000"},
      {run({"--export", "particles:ply", "--export-rate", "nan"}), 2, "is not a number from"},
      {run({"--export-rate", "30"}), 2, "--export-rate requires --export"},
      {{"host", "spoon", "--export", "particles:ply"}, 2, "--export requires --out"},
      {{"replay", "none.rec", "--export", "particles:xyz"}, 2, "There are particles:ply"},
  };
  for (const auto& one : cases) {
    const Outcome outcome = test::slosh(one.arguments);
    EXPECT_EQ(outcome.code, one.code) << outcome.err;
    EXPECT_NE(outcome.err.find(one.words), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("sampling"), std::string::npos) << outcome.err;
  }
}

TEST_F(ExportTest, AFullDiskEndsTheFramesAndNotTheRun) {
  // Files of at most 64 kB stand for a disk that fills; a frame of particles is larger.
  std::string command = "trap '' XFSZ; ulimit -f 64; exec '" + test::program() + "'";
  for (const std::string& word : run({"--out", "out", "--export", "particles:ply"})) command += " " + word;
  const Outcome outcome = test::Process({"bash", "-c", command}, test::test_folder()).wait();
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("the frames for export have ended"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("File too large"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(at("out/wrenches.csv"))) << "the run went on";
  for (const fs::directory_entry& file : fs::directory_iterator(at("out/frames")))
    EXPECT_EQ(file.path().filename(), "frames.csv") << "no part of a frame is left";
}

TEST_F(ExportTest, FramesOfAnEarlierRunAreNotLost) {
  ASSERT_EQ(test::slosh(run({"--out", "out", "--export", "particles:ply"})).code, 0);
  fs::remove(at("out/summary.json"));
  for (const char* name : {"wrenches.csv", "poses.csv", "wrenches.png"}) fs::remove(at("out") / name);
  Outcome outcome = test::slosh(run({"--out", "out"}));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("frames/frames.csv"), std::string::npos) << outcome.err;
  outcome = test::slosh(run({"--out", "out", "--overwrite"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_FALSE(fs::exists(at("out/frames"))) << "given up";
}

}  // namespace
}  // namespace slosh
