// How a run ends that cannot go on as it was meant to: stopped early, without room for its files, with an
// earlier run in its place.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "peer/output/plot.h"
#include "process.h"

namespace slosh {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::read_text;

class EndingsTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::remove_all(test::test_folder()); }
  static fs::path at(const std::string& name) { return test::test_folder() / name; }
  static std::vector<std::string> quick(const std::vector<std::string>& more) {
    std::vector<std::string> all{"play", "probe",     "--headless", "--no-render", "--threads",
                                 "1",    "--spacing", "0.012",      "--seconds",   "0.1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

struct Stop {
  const char* phase;  ///< during which
  int signal_number;
  std::vector<std::string> arguments;
};

class StoppedEarly : public EndingsTest, public ::testing::WithParamInterface<Stop> {};

TEST_P(StoppedEarly, EndsBeforeTheRunBegins) {
  std::vector<std::string> command{"env", "XDG_STATE_HOME=" + at("state").string(), test::program()};
  command.insert(command.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  test::Process run(command, test::test_folder());
  const auto says = [](const std::string& words) {
    return read_text(at("stderr.txt")).find(words) != std::string::npos;
  };
  while (run.running() && !says(std::string(GetParam().phase) + "\n"))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(run.running()) << read_text(at("stderr.txt"));
  run.signal(GetParam().signal_number);
  const Outcome outcome = run.wait();
  EXPECT_EQ(outcome.code, 128 + GetParam().signal_number);
  EXPECT_NE(outcome.err.find("interrupted before the run began: nothing was written"), std::string::npos)
      << outcome.err;
  for (const char* later : {"running", "hosting", "plotting"})
    EXPECT_EQ(outcome.err.find(later), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(at("out/wrenches.csv")));
}

const std::vector<std::string> kAuto{"play",      "bucket", "--headless", "--threads", "1",
                                     "--spacing", "auto",   "--out",      "out"};
const std::vector<std::string> kLarge{"play",        "pool",  "--headless", "--threads", "1",
                                      "--particles", "30000", "--out",      "out"};
const std::vector<std::string> kHost{"host",        "pool",  "--threads", "1",
                                     "--particles", "30000", "--listen",  "127.0.0.1:0"};
INSTANTIATE_TEST_SUITE_P(Phases, StoppedEarly,
                         ::testing::Values(Stop{"measuring", SIGINT, kAuto},
                                           Stop{"sampling", SIGTERM, kLarge},
                                           Stop{"settling", SIGINT, kLarge}, Stop{"settling", SIGTERM, kHost},
                                           Stop{"settling", SIGHUP, kHost}),
                         [](const auto& tried) {
                           return std::string(tried.param.phase) + "_" + tried.param.arguments[0] + "_" +
                                  std::to_string(tried.param.signal_number);
                         });

TEST_F(EndingsTest, ALongSamplingIsToldBeforeAndTheFirstSignalEndsIt) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"check", "pool", "--spacing", "0.003"},
        {"play", "pool", "--headless", "--no-render", "--spacing", "0.003", "--out", "out"}}) {
    std::vector<std::string> command{test::program()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    test::Process run(command, test::test_folder());
    while (run.running() && read_text(at("stderr.txt")).find("sampling takes about") == std::string::npos)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(run.running()) << read_text(at("stderr.txt"));
    run.signal(SIGINT);
    const Outcome outcome = run.wait();
    EXPECT_EQ(outcome.code, 128 + SIGINT) << outcome.err;
    EXPECT_NE(outcome.err.find(" s: some "), std::string::npos) << "how long: " << outcome.err;
    EXPECT_NE(outcome.err.find("particles of bodies"), std::string::npos) << outcome.err;
  }
}

TEST_F(EndingsTest, AFullDiskIsSaidAndLeavesWholeRows) {
  // Files of at most 8 kB stand for a disk that fills: what is beyond is not written.
  const std::string blocks = "8";
  std::string command = "trap '' XFSZ; ulimit -f " + blocks + "; exec '" + test::program() + "'";
  for (const std::string& word : quick({"--out", "out"})) command += " " + word;
  const std::size_t seconds = command.find("--seconds 0.1");
  command.replace(seconds, 13, "--seconds 1.0");
  const Outcome outcome = test::Process({"bash", "-c", command}, test::test_folder()).wait();
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  for (const char* table : {"wrenches.csv", "poses.csv"}) {
    EXPECT_NE(outcome.err.find(std::string(table) + " ends early: File too large"), std::string::npos)
        << outcome.err;
    const std::string text = read_text(at("out") / table);
    EXPECT_GT(text.size(), 8000u);
    EXPECT_EQ(text.back(), '\n') << "cut after a whole row";
  }
  EXPECT_NE(outcome.err.find("; the run goes on"), std::string::npos)
      << "said when it happens: " << outcome.err;
  const Result<std::vector<WrenchSeries>> felt = read_wrenches(at("out/wrenches.csv"));
  ASSERT_TRUE(felt) << felt.error().text();
  EXPECT_GT(felt.value()[0].time.size(), 50u);
  EXPECT_NE(outcome.err.find("the plot: "), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(at("out/wrenches.png"))) << "whole or not at all";
  const nlohmann::json summary = nlohmann::json::parse(read_text(at("out/summary.json")));
  EXPECT_EQ(summary["problems"].size(), 2u) << summary["problems"];
  EXPECT_EQ(outcome.out.find("wrenches.png"), std::string::npos) << "what is not there is not listed";
}

TEST_F(EndingsTest, WithoutAnyRoomNoSummaryIsPromised) {
  // Less than a table's rows and a summary need, more than the tables' headers.
  std::string command = "trap '' XFSZ; ulimit -f 1; exec '" + test::program() + "'";
  for (const std::string& word : quick({"--out", "out"})) command += " " + word;
  const Outcome outcome = test::Process({"bash", "-c", command}, test::test_folder()).wait();
  EXPECT_NE(outcome.code, 0);
  EXPECT_EQ(outcome.out.find("summary.json"), std::string::npos) << outcome.out;
  EXPECT_FALSE(fs::exists(at("out/summary.json")));
  EXPECT_FALSE(fs::exists(at("out/summary.json.part")));
}

TEST_F(EndingsTest, ASecondRunDoesNotReplaceTheFirst) {
  Outcome outcome = test::slosh(quick({"--out", "out"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string first = read_text(at("out/wrenches.csv"));
  outcome = test::slosh(quick({"--out", "out"}));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("holds an earlier run's"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("--overwrite"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("sampling"), std::string::npos) << "and says so before it takes long";
  EXPECT_EQ(read_text(at("out/wrenches.csv")), first);
  outcome = test::slosh(quick({"--out", "out", "--overwrite"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(at("out/summary.json")));

  // Without a wish, the next free one.
  ASSERT_EQ(test::slosh(quick({})).code, 0);
  outcome = test::slosh(quick({}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("Written to out/probe-2:"), std::string::npos) << outcome.out;
  EXPECT_TRUE(fs::exists(at("out/probe/summary.json")));
  EXPECT_TRUE(fs::exists(at("out/probe-2/summary.json")));
}

TEST_F(EndingsTest, NumbersThatAreNoneAreRefused) {
  for (const char* number : {"nan", "-nan", "inf", "-inf", "NAN", "1e999", "-1", "0", "", "1s"}) {
    const Outcome outcome =
        test::slosh({"play", "probe", "--no-render", "--headless", std::string("--seconds=") + number});
    EXPECT_EQ(outcome.code, 2) << number << outcome.err;
    EXPECT_NE(outcome.err.find("--seconds"), std::string::npos) << outcome.err;
  }
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"play", "--fps", "nan"},
                                                    {"plan", "bucket", "--spacing", "nan"},
                                                    {"replay", "x.rec", "--seconds", "nan"},
                                                    {"join", "x", "--seconds", "nan"},
                                                    {"watch", "x", "--seconds", "nan"},
                                                    {"host", "bucket", "--seconds", "nan"},
                                                    {"play", "--threads", "nan"},
                                                    {"play", "--particles", "nan"},
                                                    {"play", "--bilateral", "nan"},
                                                    {"host", "--wait", "nan"},
                                                    {"host", "--max-watchers", "nan"}}) {
    const Outcome outcome = test::slosh(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments[0] << " " << arguments[1] << outcome.err;
  }
  EXPECT_EQ(test::slosh({"play", "probe", "--headless", "--spacing", "nan"}).code, 1);
}

TEST_F(EndingsTest, WhatCannotBeMetIsSaidBeforeTheMeasuring) {
  fs::create_directories(test::test_folder());
  std::ofstream(at("earlier.rec")) << "an afternoon's work";
  for (const std::vector<std::string>& bad :
       std::vector<std::vector<std::string>>{{"--device", "joystick"},
                                             {"--device", "mouse"},
                                             {"--device", "replay:nothing.csv"},
                                             {"--size", "640"},
                                             {"--record", "nowhere/x.rec"},
                                             {"--record", "."},
                                             {"--record", "earlier.rec"},
                                             {"--out", "/proc/nowhere"}}) {
    std::vector<std::string> arguments{"play", "probe", "--headless", "--no-render", "--spacing", "auto"};
    arguments.insert(arguments.end(), bad.begin(), bad.end());
    const Outcome outcome = test::slosh(arguments);
    EXPECT_EQ(outcome.code, 1) << bad[1] << outcome.err;
    EXPECT_EQ(outcome.err.find("measuring"), std::string::npos) << bad[1] << outcome.err;
  }
}

}  // namespace
}  // namespace slosh
