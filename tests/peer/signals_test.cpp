// What is recorded of a hand at the device loop's own rate: a row each tick, and its signals stage by stage.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "peer/output/recorder.h"
#include "peer/output/signal_table.h"
#include "servo_kit.h"

namespace slosh {
namespace {

std::filesystem::path signals_folder(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / ("signals_" + name);
  std::filesystem::create_directories(path);
  return path;
}

std::vector<std::map<std::string, double>> rows_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line, word;
  std::getline(in, line);
  std::vector<std::string> names;
  for (std::istringstream words(line); std::getline(words, word, ',');) names.push_back(word);
  std::vector<std::map<std::string, double>> rows;
  while (std::getline(in, line)) {
    auto& row = rows.emplace_back();
    std::size_t i = 0;
    for (std::istringstream words(line); std::getline(words, word, ','); ++i)
      row[names.at(i)] = std::stod(word);
    EXPECT_EQ(i, names.size()) << line;
  }
  return rows;
}

/// s by which a busy machine's loop is early or late, tick by tick: to 0.4 of a period.
double jitter(int tick) {
  return 1e-3 * 0.4 * std::sin(1.7 * tick) * std::cos(0.3 * tick);
}

/// A loop that wakes now early, now late has no gap in its rows and none twice, whatever the phase of
/// simulated time.
TEST(Signals, ARowATickIsAskedForAndEachTickHasOne) {
  for (const double phase : {0.0, 0.0002, 0.0005, 0.00099}) {
    ServoOptions options;
    options.sample_interval = 0.001;
    test::ServoKit kit(limits_without_a_hand(), options);
    constexpr int kTicks = 2000;
    int rows = 0;
    double last = -1.0, longest = 0.0;
    const auto take = [&] {
      for (ServoSample sample; kit.servo->samples().pop(sample); ++rows) {
        if (last >= 0.0) longest = std::max(longest, sample.time - last);
        EXPECT_GT(sample.time, last);
        last = sample.time;
      }
    };
    for (int i = 0; i < kTicks; ++i) {
      const double wall = 0.01 + phase + 0.001 * i;
      kit.publish(wall);
      kit.tick(wall + jitter(i));
      take();
    }
    kit.servo->let_go();
    take();
    EXPECT_EQ(rows, kTicks) << "phase " << phase;
    EXPECT_LT(longest, 0.0019) << "no two ticks' time between two rows";
  }
}

TEST(Signals, AreAsTheHandHadThemStageByStage) {
  const std::filesystem::path out = signals_folder("stages");
  DeviceLimits limits = limits_without_a_hand();
  limits.max_force = 3.0;
  limits.max_force_rate = 100.0;
  ServoOptions options;
  options.signals = true;
  test::ServoKit kit(limits, options);
  Result<std::unique_ptr<Recorder>> recorder = Recorder::start(*kit.servo, out);
  ASSERT_TRUE(recorder) << recorder.error().text();
  Pose at_device;
  at_device.position = {0.1, 0.2, 0.3};
  // It stands at its grip at first, and is 4 mm off it from 0.1 s on: 4 N by 1000 N/m, of which the device
  // gives 3.
  constexpr int kTicks = 600;
  for (int i = 0; i < kTicks; ++i) {
    const double wall = 0.01 + 0.001 * i;
    kit.publish(wall);
    kit.device->next.pose.position.x = std::min(1e-5 * std::max(i - 100, 0), 0.004);
    kit.device->next.at_device = at_device;
    if (i > 0) kit.device->next.rendered = Wrench{{0.5 * kit.device->last.force.x, 0.0, 0.0}, {}};
    kit.tick(wall);
  }
  recorder.value()->stop();
  const auto rows = rows_of(out / "signals.csv");
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(kTicks));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    EXPECT_EQ(row.at("tick"), static_cast<double>(i));
    EXPECT_EQ(row.at("reading"), static_cast<double>(i + 1));
    EXPECT_NEAR(row.at("wall_s"), 0.001 * static_cast<double>(i), 1e-6);
    EXPECT_NEAR(row.at("period_ms"), i == 0 ? 0.0 : 1.0, 1e-4);
    EXPECT_EQ(row.at("age_ms"), 0.0);
    EXPECT_EQ(row.at("device_z_m"), 0.3);
    EXPECT_EQ(row.at("guarded_fx_n"), row.at("coupled_fx_n"))
        << "alone on a fixed body no passivity controller acts";
    if (i > 0) {
      EXPECT_LE(std::abs(row.at("sent_fx_n") - rows[i - 1].at("sent_fx_n")), 0.1 + 1e-6) << "N a ms";
      EXPECT_NEAR(row.at("rendered_fx_n"), 0.5 * rows[i - 1].at("sent_fx_n"), 1e-6);
    }
  }
  EXPECT_TRUE(std::isnan(rows[0].at("rendered_fx_n"))) << "nothing was written yet";
  const auto& end = rows.back();
  EXPECT_NEAR(end.at("hand_x_m"), 0.004, 1e-9);
  EXPECT_NEAR(end.at("coupled_fx_n"), -4.0, 0.01);
  EXPECT_NEAR(end.at("wanted_fx_n"), -4.0, 0.01);
  EXPECT_NEAR(end.at("sent_fx_n"), -3.0, 1e-6);
}

TEST(Signals, AreNotKeptWhereNobodyAsksForThem) {
  const std::filesystem::path out = signals_folder("none");
  std::filesystem::remove(out / "signals.csv");
  test::ServoKit kit;
  Result<std::unique_ptr<Recorder>> recorder = Recorder::start(*kit.servo, out);
  ASSERT_TRUE(recorder);
  kit.publish(0.0);
  kit.tick(0.0);
  recorder.value()->stop();
  EXPECT_FALSE(std::filesystem::exists(out / "signals.csv"));
  EXPECT_EQ(kit.servo->samples_lost(), 0u);
}

/// A ring that nobody empties is full at once, and each signal that finds no room is counted.
TEST(Signals, WhatFindsNoRoomIsCounted) {
  ServoOptions options;
  options.signals = true;
  options.sample_capacity = 10;
  options.sample_interval = 1.0;
  test::ServoKit kit(limits_without_a_hand(), options);
  for (int i = 0; i < 25; ++i) {
    kit.publish(0.001 * i);
    kit.tick(0.001 * i);
  }
  EXPECT_EQ(kit.servo->samples_lost(), 15u);
}

}  // namespace
}  // namespace slosh
