#include "peer/output/summary.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "peer/output/progress.h"
#include "sim/snapshot.h"

namespace slosh {
namespace {

RunSummary example() {
  RunSummary s;
  s.scene = "bucket";
  s.spacing = 0.011;
  s.spacing_reason = "asked for";
  s.fluid_particles = 2812;
  s.boundary_particles = 13104;
  s.steps = 10000;
  s.simulated = 10.0;
  s.wall = 10.5;
  s.real_time_factor = 10.0 / 10.5;
  s.step_ms = {0.8, 1.1, 3.0};
  s.step_share = {{"sort_fluid", 0.1}, {"density", 0.3}};
  s.device_loop_us = {1000, 1040, 1900};
  s.device_scheduler = "SCHED_OTHER";
  s.rendered = true;
  s.frames = 301;
  s.status = kStatusTimeSlipped | kStatusForceLimited;
  s.devices = {{"left_hand", "script", 31.2, 1.25, 0.5}};
  s.backend = "cpu";
  s.version = "0.1.0";
  s.folder = "out/bucket";
  s.files = {"wrenches.csv", "summary.json"};
  return s;
}

TEST(Summary, JsonHasEveryFieldThatIsPromised) {
  const nlohmann::ordered_json json = to_json(example());
  for (const char* field : {"scene", "spacing_m", "spacing_reason", "particles", "steps", "simulated_s",
                            "wall_s", "real_time_factor", "step_ms", "step_share", "device_loop_us", "render",
                            "status", "backend", "threads", "machine", "version", "devices", "interrupted"}) {
    EXPECT_TRUE(json.contains(field)) << field;
  }
  EXPECT_EQ(json["particles"]["fluid"], 2812);
  EXPECT_EQ(json["particles"]["boundary"], 13104);
  EXPECT_EQ(json["step_ms"]["p99"], 1.1);
  EXPECT_EQ(json["step_share"]["density"], 0.3);
  EXPECT_EQ(json["device_loop_us"]["max"], 1900.0);
  EXPECT_EQ(json["device_loop_us"]["scheduler"], "SCHED_OTHER");
  EXPECT_EQ(json["render"]["frames"], 301);
  EXPECT_EQ(json["status"].size(), 2u);
  EXPECT_EQ(json["devices"][0]["peak_force_n"], 31.2);
  EXPECT_EQ(json["devices"][0]["clipped_s"], 0.5);
}

TEST(Summary, InWordsSaysTheNumbers) {
  const std::string text = in_words(example());
  for (const char* part :
       {"2 812", "13 104", "11.0 mm", "× 0.95", "left_hand (script) felt up to 31.2 N and 1.25",
        "for 0.5 s all that its device gives", "out/bucket", "wrenches.csv"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
  EXPECT_EQ(text.find("interrupted"), std::string::npos);
}

TEST(Summary, ALoopThatWasLateForWantOfPriorityIsToldHowToGetIt) {
  RunSummary s = example();
  s.device_ticks = 10000;
  const auto hinted = [&] { return in_words(s).find("rtprio 20") != std::string::npos; };
  s.device_missed = 10;
  EXPECT_FALSE(hinted()) << "one in a thousand";
  s.device_missed = 11;
  EXPECT_TRUE(hinted());
  s.device_scheduler = "SCHED_FIFO";
  EXPECT_FALSE(hinted()) << "it has it";
}

TEST(Summary, FileIsWholeOrAnError) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "slosh_summary.json";
  ASSERT_TRUE(write_summary(file, example()));
  std::ifstream in(file);
  EXPECT_EQ(nlohmann::json::parse(in)["scene"], "bucket");
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
  EXPECT_FALSE(write_summary("/nowhere/summary.json", example()));
}

TEST(Summary, WordsFromElsewhereAreFitToBeShown) {
  RunSummary summary;
  summary.scene = "\x1b[2Jscene";
  summary.devices.push_back({"grip\u009b31m", "script", 1.0, 2.0});
  summary.network.emplace();
  summary.network->ended = "bye\x1b]0;owned\x07\x9b";
  const std::string words = in_words(summary);
  for (const char* obeyed : {"\x1b", "\x07", "\u009b", "\x9b"})
    EXPECT_EQ(words.find(obeyed), std::string::npos) << words;
  EXPECT_NE(words.find("grip?31m"), std::string::npos) << words;
}

TEST(Summary, StatusWordsAreOnePerBit) {
  EXPECT_TRUE(status_words(0).empty());
  EXPECT_EQ(status_words(kStatusNonFinite | kStatusEscaped | kStatusInputRejected).size(), 3u);
}

TEST(Summary, StatusesHaveTheirNumbers) {
  RunSummary s;
  s.fluid_particles = 344;
  s.retired_particles = 264;
  s.steps = 1714;
  s.status = kStatusEscaped | kStatusSpeedLimited | kStatusForceLimited;
  s.status_steps[1] = 12;
  s.status_steps[2] = 37;
  const std::vector<std::string> words = status_words(s);
  ASSERT_EQ(words.size(), 3u);
  EXPECT_NE(words[0].find("(264 of 344, in 12 of 1 714 steps)"), std::string::npos) << words[0];
  EXPECT_NE(words[1].find("(in 37 of 1 714 steps)"), std::string::npos) << words[1];
  EXPECT_EQ(words[2].find("("), std::string::npos) << "the device loop does not count: " << words[2];
  EXPECT_NE(in_words(s).find("264 of 344"), std::string::npos);
}

/// A scene that is made to spill ends without a word of loss; drops that bounced get the advice.
TEST(Summary, WhatWasSpilledIsNoLoss) {
  RunSummary s;
  s.fluid_particles = 1376;
  s.retired_particles = 504;
  s.fluid_mass_start = 3.7;
  s.fluid_mass_end = 2.34;
  s.status = kStatusEscaped;
  std::string words = in_words(s);
  EXPECT_NE(
      words.find("504 of 1 376 fluid particles were spilled over the edge of the domain, 1.36 of 3.7 kg."),
      std::string::npos)
      << words;
  EXPECT_EQ(words.find("lost"), std::string::npos) << words;
  EXPECT_EQ(words.find("mug"), std::string::npos) << words;
  EXPECT_NE(words.find("fluid left the domain and is out of the world (504 of 1 376)"), std::string::npos)
      << words;
  s.retired_particles = 55;
  s.fluid_mass_end = 3.55;
  EXPECT_NE(in_words(s).find("mug"), std::string::npos) << "4 %: it bounced";
  s.walls_hold = false;
  s.lost_particles = 55;
  words = in_words(s);
  EXPECT_NE(
      words.find(
          "55 of 1 376 fluid particles were lost: they left the domain, over its edge or through a wall"),
      std::string::npos)
      << words;
}

/// Kilogrammes are of the run; particles that left while it settled are none of it.
TEST(Summary, WhatSettlingLostIsToldApart) {
  RunSummary s;
  s.fluid_particles = 1240;
  s.retired_particles = 1000;
  s.lost_particles = 20;
  s.retired_settling = 840;
  s.lost_settling = 15;
  s.fluid_mass_start = 0.4;
  s.fluid_mass_end = 0.24;
  s.particles_in_solids = 1;
  const std::string words = in_words(s);
  for (const char* told :
       {"825 of 1 240 fluid particles were spilled over the edge of the domain, while the world settled, "
        "before the run",
        "15 of 1 240 fluid particles were lost: not finite any more, while the world settled",
        "155 of 400 fluid particles were spilled over the edge of the domain.",
        "5 of 400 fluid particles were lost: not finite any more; with what was spilled, 0.16 of 0.4 kg"})
    EXPECT_NE(words.find(told), std::string::npos) << told << " is not in: " << words;
  EXPECT_NE(words.find("1 fluid particle is inside a solid"), std::string::npos) << words;
  EXPECT_EQ(to_json(s)["particles"]["retired_settling"], 840);
  EXPECT_EQ(to_json(s)["particles"]["spilled"], 980);
  EXPECT_EQ(to_json(s)["particles"]["lost"], 20);
  EXPECT_EQ(to_json(s)["particles"]["spilled_settling"], 825);
  EXPECT_EQ(to_json(s)["particles"]["lost_settling"], 15);
  s.retired_particles = 840;
  s.lost_particles = 15;
  s.fluid_mass_end = 0.4;
  EXPECT_EQ(in_words(s).find(" kg"), std::string::npos) << "the run itself lost nothing";
}

TEST(Grouped, ThousandsApart) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1 000");
  EXPECT_EQ(grouped(1234567), "1 234 567");
}

TEST(Progress, ATerminalGetsOnlyWhatItCanShow) {
  const std::string hostile = "a\x1b[2Jb\u009bc\u202ed\x9b\r";
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  {
    Progress progress(false, 0.0);
    progress.phase("loading", hostile);
    progress.update(0.5, hostile);
    progress.note(hostile + "\n" + hostile);
    progress.answer(hostile, hostile);
  }
  const std::string shown = testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout();
  for (const char* obeyed : {"\x1b", "\u009b", "\u202e", "\x9b", "\r"})
    EXPECT_EQ(shown.find(obeyed), std::string::npos) << obeyed;
  EXPECT_NE(shown.find("a?[2Jb?cd??\na?[2Jb?cd??\n"), std::string::npos) << "lines stay lines: " << shown;
}

TEST(Progress, ALogSaysNothingTwice) {
  testing::internal::CaptureStderr();
  {
    Progress progress(false, 0.0);
    progress.phase("encoding");
    for (const char* text : {"93 to draw", "93 to draw", "92 to draw", "93 to draw"})
      progress.update(0.0, text);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "encoding\nencoding   0 %  93 to draw\nencoding   0 %  92 to draw\nencoding   0 %  93 to draw\n");
}

TEST(Progress, NorDoesWhatIsPastedMoveIt) {
  testing::internal::CaptureStderr();
  {
    Progress progress(true, 0.0);
    progress.typed("x\x9b[2Jy");
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "\r\x1b[K> x?[2Jy\n") << "the only escape is its own";
}

TEST(Columns, CountsCodePoints) {
  EXPECT_EQ(columns("real time × 1.00"), 16u);
  EXPECT_EQ(columns(""), 0u);
}

}  // namespace
}  // namespace slosh
