// `slosh play` from the command line to its files.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "peer/haptics/script_device.h"
#include "peer/output/plot.h"
#include "peer/output/recorder.h"
#include "play_kit.h"
#include "process.h"
#include "render/image.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::Outcome;
using test::PlayTest;
using test::probe;
using test::read_text;

/// The shipped bucket is there to be spilled: nothing of it is called lost, in the film's tables, the words
/// or a replay.
TEST_F(PlayTest, WhatTheBucketSpillsIsNotLost) {
  const Outcome outcome = test::slosh({"play", "bucket", "--headless", "--no-render", "--unpaced",
                                       "--spacing", "0.0139", "--threads", "1", "--seconds", "4", "--measure",
                                       "0.5", "--record", "b.rec", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json particles = json::parse(read_text(out() / "summary.json"))["particles"];
  EXPECT_GT(particles["spilled"].get<int>(), 50);
  EXPECT_EQ(particles["lost"], 0);
  EXPECT_EQ(particles["retired"], particles["spilled"]);
  EXPECT_NE(outcome.out.find("fluid particles were spilled over the edge of the domain"), std::string::npos);
  for (const char* word : {"lost", "mug"})
    EXPECT_EQ(outcome.out.find(word), std::string::npos) << outcome.out;
  const std::string rows = read_text(out() / "probes.csv");
  EXPECT_TRUE(rows.starts_with("time_s,particles,spilled,lost,in_solids,")) << rows.substr(0, 60);
  std::stringstream last(rows.substr(rows.rfind('\n', rows.size() - 2) + 1));
  std::vector<std::string> fields;
  for (std::string field; std::getline(last, field, ',');) fields.push_back(field);
  ASSERT_GT(fields.size(), 4u);
  EXPECT_GT(std::stoi(fields[2]), 50);
  EXPECT_EQ(std::stoi(fields[1]) + std::stoi(fields[2]), particles["fluid"].get<int>());
  EXPECT_EQ(fields[3], "0");
  const Outcome again = test::slosh({"replay", "b.rec", "--headless", "--no-render", "--threads", "1"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find(std::to_string(particles["spilled"].get<int>()) + " of "), std::string::npos)
      << again.out;
}

void expect_rows(const std::filesystem::path& folder, std::size_t devices, double seconds) {
  const Result<std::vector<WrenchSeries>> series = read_wrenches(folder / "wrenches.csv");
  ASSERT_TRUE(series) << series.error().text();
  ASSERT_EQ(series.value().size(), devices);
  for (const WrenchSeries& s : series.value()) {
    ASSERT_GT(s.time.size(), 10u);
    EXPECT_LT(s.time.front(), 0.05);
    EXPECT_NEAR(s.time.back(), seconds, 0.1);
    for (std::size_t i = 1; i < s.time.size(); ++i) ASSERT_GT(s.time[i], s.time[i - 1]);
    for (const Wrench& w : s.on_hand) {
      ASSERT_TRUE(std::isfinite(glm::length(w.force)));
      ASSERT_TRUE(std::isfinite(glm::length(w.torque)));
    }
  }
}

TEST_F(PlayTest, WritesEveryFileOfARun) {
  const Outcome outcome = test::slosh({"play", "bucket", "--headless", "--seconds", "1", "--spacing", "0.012",
                                       "--size", "320x240", "--fps", "10", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file :
       {"wrenches.csv", "poses.csv", "wrenches.png", "view.mp4", "final.png", "summary.json"}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(out() / file)) << file;
    EXPECT_NE(outcome.out.find(file), std::string::npos) << "the summary names " << file;
  }
  for (const char* phase : {"loading", "sampling", "running", "encoding", "plotting"}) {
    EXPECT_NE(outcome.err.find(phase), std::string::npos) << phase;
  }
  EXPECT_EQ(read_text(out() / "wrenches.csv").find(std::string(kWrenchesHeader) + "\n"), 0u);
  expect_rows(out(), 2, 1.0);

  const json summary = json::parse(read_text(out() / "summary.json"));
  EXPECT_EQ(summary["scene"], "bucket");
  EXPECT_EQ(summary["spacing_m"], 0.012);
  EXPECT_GT(summary["particles"]["fluid"], 100);
  EXPECT_NEAR(summary["simulated_s"].get<double>(), 1.0, 0.01);
  EXPECT_NEAR(summary["steps"].get<double>() * summary["time_step_s"].get<double>(), 1.0, 0.01);
  EXPECT_GT(summary["step_ms"]["p50"], 0.0);
  EXPECT_GE(summary["step_ms"]["p99"], summary["step_ms"]["p50"]);
  EXPECT_GT(summary["device_loop_us"]["p50"], 0.0);
  EXPECT_GE(summary["device_loop_us"]["max"], summary["device_loop_us"]["p99"]);
  EXPECT_EQ(summary["render"]["frames"], 11);
  EXPECT_EQ(summary["render"]["dropped"], 0);
  EXPECT_EQ(summary["backend"], "cpu");
  EXPECT_EQ(summary["samples_lost"], 0);
  EXPECT_FALSE(summary["interrupted"]);

  EXPECT_EQ(probe(out() / "view.mp4", "nb_read_frames"), "11");
  EXPECT_EQ(probe(out() / "view.mp4", "codec_name"), "h264");
  const Result<Image> last = read_png(out() / "final.png");
  ASSERT_TRUE(last) << last.error().text();
  EXPECT_EQ(last.value().width, 320);
  EXPECT_EQ(last.value().height, 240);

#ifndef SLOSH_SANITIZED
  // Two hands hold one bucket: after the first swing they carry it, so both are pulled down. A sanitizer's
  // steps take longer than a device waits for a force, which then has faded, as it must.
  const std::vector<WrenchSeries> felt = read_wrenches(out() / "wrenches.csv").value();
  for (const WrenchSeries& hand : felt) EXPECT_LT(hand.on_hand.back().force.y, -2.0);
#endif
}

TEST_F(PlayTest, WithoutGnuplotTheSheetIsMissedInWordsAndNothingElse) {
  const std::vector<std::string> without{"env", "PATH=" + test::test_folder().string(), test::program()};
  std::vector<std::string> play = without;
  play.insert(play.end(), {"play", "probe", "--headless", "--no-render", "--unpaced", "--seconds", "0.2",
                           "--spacing", "0.0135", "--out", "out"});
  Outcome outcome = test::Process(play, test::test_folder()).wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("gnuplot is not installed"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(out() / "wrenches.png"));
  expect_rows(out(), 1, 0.2);
  EXPECT_TRUE(json::parse(read_text(out() / "summary.json"))["problems"].empty());
  // A report is told so before it has measured for minutes.
  std::vector<std::string> report = without;
  report.insert(report.end(), {"report", "figure", "10", "--out", "ten"});
  outcome = test::Process(report, test::test_folder()).wait();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("apt-get install gnuplot-nox"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(test::test_folder() / "ten"));
}

/// How many there are goes by the machine; how near they lie does not.
TEST_F(PlayTest, HandsAreRecordedAtTheDeviceLoopsOwnRateWhereThatIsAskedFor) {
  const Outcome outcome = test::slosh({"play", "probe", "--headless", "--no-render", "--spacing", "0.012",
                                       "--seconds", "0.5", "--rows", "1000", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Result<std::vector<WrenchSeries>> series = read_wrenches(out() / "wrenches.csv");
  ASSERT_TRUE(series);
  const std::vector<double>& time = series.value().front().time;
  double nearest = 1.0;
  for (std::size_t i = 1; i < time.size(); ++i) nearest = std::min(nearest, time[i] - time[i - 1]);
  EXPECT_LT(nearest, 0.0015);
  EXPECT_EQ(test::slosh({"play", "probe", "--headless", "--rows", "5000"}).code, 2);
}

/// Each tick of the loop has its rows, whatever the machine: ticks are numbered, and the periods between them
/// add up to the time on the wall.
TEST_F(PlayTest, SignalsAreOfEachTickOfTheDeviceLoop) {
  const Outcome outcome =
      test::slosh({"play", "spoon", "--headless", "--no-render", "--spacing", "0.012", "--seconds", "1",
                   "--device", "operator:tight", "--signals", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json summary = json::parse(read_text(out() / "summary.json"));
  EXPECT_EQ(summary["samples_lost"], 0);
  std::ifstream in(out() / "signals.csv");
  std::string line, word;
  std::getline(in, line);
  EXPECT_EQ(line.find("time_s,tick,device,wall_s,period_ms,reading,age_ms,engaged,device_x_m,"), 0u) << line;
  std::uint64_t ticks = 0;
  double passed = 0.0, wall = 0.0, most = 0.0;
  for (; std::getline(in, line); ++ticks) {
    std::vector<double> fields;
    for (std::istringstream words(line); std::getline(words, word, ',');) fields.push_back(std::stod(word));
    ASSERT_EQ(fields.size(), 58u) << line;
    EXPECT_EQ(fields[1], static_cast<double>(ticks)) << "none is missing";
    wall = fields[3];
    passed += 1e-3 * fields[4];
    most = std::max(most, std::hypot(fields[46], fields[47], fields[48]));
  }
  EXPECT_NEAR(passed, wall, 1e-4);
  EXPECT_EQ(ticks, summary["device_loop_us"]["ticks"].get<std::uint64_t>() + 1)
      << "and the first, before it is timed";
  EXPECT_GT(most, 0.1) << "N that were sent";
}

/// To feel what a slower host is like: the world meets the hand 100 times a second in place of 344, in as
/// many sub-steps as its own steps ask for. No force is asserted: it goes by the wall's clock.
TEST_F(PlayTest, AWorldStepsAsSeldomAsAskedFor) {
  const Outcome outcome =
      test::slosh({"play", "spoon", "--headless", "--no-render", "--spacing", "0.012", "--threads", "1",
                   "--seconds", "1", "--device", "operator:tight", "--step-rate", "100", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json summary = json::parse(read_text(out() / "summary.json"));
  EXPECT_DOUBLE_EQ(summary["time_step_s"], 0.01);
  expect_rows(out(), 1, 1.0);
  for (const char* other : {"--unpaced", "--record"}) {
    std::vector<std::string> words{"play", "spoon", "--headless", "--step-rate", "100", other};
    if (words.back() == "--record") words.push_back("run.rec");
    const Outcome refused = test::slosh(words);
    EXPECT_EQ(refused.code, 2) << other;
    EXPECT_NE(refused.err.find("--step-rate"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(test::slosh({"play", "spoon", "--headless", "--step-rate", "5"}).code, 2);
}

TEST_F(PlayTest, ARecordedRunCanBeReplayed) {
  const std::vector<std::string> common = {"play",      "probe", "--no-render", "--threads", "1",
                                           "--seconds", "1",     "--spacing",   "0.012",     "--out"};
  std::vector<std::string> first = common;
  first.push_back("first");
  Outcome outcome = test::slosh(first);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::vector<std::string> second = common;
  second.insert(second.end(), {"second", "--device", "replay:first/poses.csv"});
  outcome = test::slosh(second);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<PoseKey> a = read_poses(out("first") / "poses.csv", 0).value();
  const std::vector<PoseKey> b = read_poses(out("second") / "poses.csv", 0).value();
  EXPECT_NEAR(glm::distance(a.back().pose.position, b.back().pose.position), 0.0, 0.002);
  EXPECT_EQ(json::parse(read_text(out("second") / "summary.json"))["devices"][0]["device"], "replay");
}

TEST_F(PlayTest, WithoutADisplayItSaysThatItBecomesAFilm) {
  const Outcome outcome =
      test::slosh({"play", "probe", "--seconds", "0.1", "--spacing", "0.012", "--size", "64x48"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("no display"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(test::test_folder() / "out" / "probe" / "view.mp4"))
      << "the default folder";
}

TEST_F(PlayTest, ChoosesASpacingSaysWhyAndTakesItAgain) {
  const auto play = [&](const std::string& folder, const std::vector<std::string>& more, int threads = 1) {
    std::vector<std::string> all{"env",           "XDG_STATE_HOME=" + out("state").string(),
                                 test::program(), "play",
                                 "probe",         "--no-render",
                                 "--threads",     std::to_string(threads),
                                 "--seconds",     "0.1",
                                 "--out",         folder};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = test::Process(all, test::test_folder()).wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return std::pair(outcome.err, json::parse(read_text(out(folder) / "summary.json")));
  };
  const auto [said, summary] = play("first", {});
  EXPECT_NE(said.find("measuring"), std::string::npos);
  EXPECT_GE(summary["spacing_m"], 0.001);
  EXPECT_NE(summary["spacing_reason"].get<std::string>().find("real time"), std::string::npos);
  const auto [said_again, again] = play("second", {});
  EXPECT_EQ(said_again.find("measuring"), std::string::npos) << "so that forces compare: " << said_again;
  EXPECT_EQ(again["spacing_m"], summary["spacing_m"]);
  EXPECT_NE(again["spacing_reason"].get<std::string>().find("--spacing auto"), std::string::npos);
  EXPECT_NE(play("third", {"--spacing", "auto"}).first.find("measuring"), std::string::npos);
  EXPECT_NE(play("fourth", {}, 2).first.find("measuring"), std::string::npos) << "another machine, so to say";
  // What is kept there and cannot be used is measured again, not believed.
  std::ofstream(out("state") / "slosh/spacings.json") << "[{\"key\": 7}, \"x\"";
  EXPECT_NE(play("fifth", {}).first.find("measuring"), std::string::npos);
}

TEST_F(PlayTest, AimsAtANumberOfParticles) {
  const Outcome outcome = test::slosh({"play", "pool", "--no-render", "--threads", "1", "--seconds", "0.05",
                                       "--particles", "4000", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const double fluid = json::parse(read_text(out() / "summary.json"))["particles"]["fluid"];
  EXPECT_NEAR(fluid, 4000.0, 1000.0);
}

/// Arguments of a run that does not end by itself.
std::vector<std::string> an_hour() {
  return {test::program(), "play",   "probe",   "--headless", "--seconds", "3600",  "--spacing",
          "0.012",         "--size", "160x120", "--fps",      "10",        "--out", "out"};
}

/// Until something was recorded and drawn, or it ended.
void wait_for_records(test::Process& run, const std::filesystem::path& out) {
  while (run.running()) {
    const Result<std::vector<WrenchSeries>> felt = read_wrenches(out / "wrenches.csv");
    if (felt && !felt.value().empty() && felt.value()[0].time.back() > 0.3) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

TEST_F(PlayTest, AnInterruptedRunLeavesValidFiles) {
  test::Process run(an_hour(), test::test_folder());
  wait_for_records(run, out());
  ASSERT_TRUE(run.running());
  run.signal(SIGINT);
  const Outcome outcome = run.wait();
  EXPECT_EQ(outcome.code, 128 + SIGINT) << outcome.err;
  EXPECT_NE(outcome.out.find("interrupted"), std::string::npos);
  const json summary = json::parse(read_text(out() / "summary.json"));
  EXPECT_TRUE(summary["interrupted"]);
  expect_rows(out(), 1, summary["simulated_s"].get<double>());
  EXPECT_EQ(std::stoi(probe(out() / "view.mp4", "nb_read_frames")), summary["render"]["frames"].get<int>());
  EXPECT_TRUE(read_png(out() / "final.png"));
  EXPECT_TRUE(read_png(out() / "wrenches.png"));
}

TEST_F(PlayTest, AKilledRunKeepsWhatWasWritten) {
  test::Process run(an_hour(), test::test_folder());
  wait_for_records(run, out());
  run.signal(SIGKILL);
  EXPECT_EQ(run.wait().code, 128 + SIGKILL);
  std::string text = read_text(out() / "wrenches.csv");
  EXPECT_GT(std::count(text.begin(), text.end(), '\n'), 100);
}

}  // namespace
}  // namespace slosh
