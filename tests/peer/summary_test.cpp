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
  s.device_loop_us = {1000, 1040, 1900};
  s.device_scheduler = "SCHED_OTHER";
  s.rendered = true;
  s.frames = 301;
  s.status = kStatusTimeSlipped | kStatusForceLimited;
  s.devices = {{"left_hand", "script", 31.2, 1.25}};
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
  EXPECT_EQ(json["device_loop_us"]["max"], 1900.0);
  EXPECT_EQ(json["device_loop_us"]["scheduler"], "SCHED_OTHER");
  EXPECT_EQ(json["render"]["frames"], 301);
  EXPECT_EQ(json["status"].size(), 2u);
  EXPECT_EQ(json["devices"][0]["peak_force_n"], 31.2);
}

TEST(Summary, InWordsSaysTheNumbers) {
  const std::string text = in_words(example());
  for (const char* part : {"2 812", "13 104", "11.0 mm", "× 0.95",
                           "left_hand (script) felt up to 31.2 N and 1.25", "out/bucket", "wrenches.csv"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
  EXPECT_EQ(text.find("interrupted"), std::string::npos);
}

TEST(Summary, FileIsWholeOrAnError) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "slosh_summary.json";
  ASSERT_TRUE(write_summary(file, example()));
  std::ifstream in(file);
  EXPECT_EQ(nlohmann::json::parse(in)["scene"], "bucket");
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
  EXPECT_FALSE(write_summary("/nowhere/summary.json", example()));
}

TEST(Summary, StatusWordsAreOnePerBit) {
  EXPECT_TRUE(status_words(0).empty());
  EXPECT_EQ(status_words(kStatusNonFinite | kStatusEscaped | kStatusInputRejected).size(), 3u);
}

TEST(Grouped, ThousandsApart) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1 000");
  EXPECT_EQ(grouped(1234567), "1 234 567");
}

TEST(Columns, CountsCodePoints) {
  EXPECT_EQ(columns("real time × 1.00"), 16u);
  EXPECT_EQ(columns(""), 0u);
}

}  // namespace
}  // namespace slosh
