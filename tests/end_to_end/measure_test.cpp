// A scene with instruments, from its file to bodies.csv and probes.csv.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "process.h"
#include "scenes/make/solid.h"
#include "scenes/make/writer.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::Outcome;
using test::read_text;

/// The columns of a table of numbers, by name; cells that are none are NaN.
std::map<std::string, std::vector<double>> columns_of(const std::filesystem::path& file) {
  std::istringstream in(read_text(file));
  std::string line, cell;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (columns.size() <= i && columns.count(cell) == 0 && names.size() <= i) {
        names.push_back(cell);
        columns[cell] = {};
        continue;
      }
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      columns[names.at(i)].push_back(end == cell.c_str() ? std::nan("") : value);
    }
  }
  return columns;
}

double mean_of_second_half(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = values.size() / 2; i < values.size(); ++i, ++count) sum += values[i];
  return sum / static_cast<double>(count);
}

class MeasureTest : public ::testing::Test {
 protected:
  static constexpr double kSpacing = 0.01;
  static constexpr double kDepth = 0.06;

  void SetUp() override {
    std::filesystem::remove_all(test::test_folder());
    std::filesystem::create_directories(test::test_folder());
    make::SceneWriter writer({{"title", "measured"}, {"spacing_m", kSpacing}, {"duration_s", 0.5}});
    const int paint = writer.add_material("paint", {});
    writer.add_node("tank", writer.add_mesh("tank", make::tank({0.16, 0.12, 0.12}, 0.03), paint), {},
                    {{"slosh", "body"}, {"measured", true}});
    const double floor = 0.03;
    writer.add_node(
        "water",
        writer.add_mesh("water", make::box({-0.08, floor, -0.06}, {0.08, floor + kDepth, 0.06}), paint), {},
        {{"slosh", "fluid"}, {"viscosity_pa_s", 0.05}});
    writer.add_node("middle", -1, {}, {{"slosh", "gauge"}});
    writer.add_node("right", writer.add_mesh("right", make::box({0.0, -0.1, -0.2}, {0.3, 0.4, 0.2}), paint),
                    {}, {{"slosh", "region"}});
    const int box = writer.add_node(
        "box", writer.add_mesh("box", make::box({-0.02, 0.0, -0.02}, {0.02, 0.04, 0.02}), paint),
        {{0.0, 0.3, 0.0}, {1, 0, 0, 0}}, {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.1}});
    const Pose grip{{0.0, 0.3, 0.0}, {1, 0, 0, 0}};
    writer.add_node("handle", -1, {}, {{"slosh", "grip"}}, box);
    writer.add_hand(
        "hand", "handle",
        [=](double t) {
          Pose pose = grip;
          pose.position.x += 0.02 * (1.0 - std::cos(12.0 * t));
          return pose;
        },
        0.5);
    ASSERT_TRUE(writer.write(test::test_folder() / "measured.gltf"));
  }
  Outcome play(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"play",      "measured.gltf", "--headless", "--no-render",
                                          "--unpaced", "--out",         out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::slosh(arguments);
  }
  std::filesystem::path file(const std::string& out, const char* name) const {
    return test::test_folder() / out / name;
  }
};

TEST_F(MeasureTest, InstrumentsAreWrittenAndTrue) {
  const Outcome outcome = play("out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto probes = columns_of(file("out", "probes.csv"));
  const auto bodies = columns_of(file("out", "bodies.csv"));
  ASSERT_EQ(probes.count("middle_level_m"), 1u);
  ASSERT_EQ(probes.count("right_mass_kg"), 1u);
  const double mass = probes.at("mass_kg").front();
  EXPECT_GT(mass, 0.6);
  EXPECT_EQ(probes.at("time_s").size(), 51u) << "a row each 0.01 s, and the first";
  EXPECT_NEAR(mean_of_second_half(probes.at("right_mass_kg")), 0.5 * mass, 0.02 * mass);
  EXPECT_NEAR(mean_of_second_half(probes.at("middle_level_m")), 0.03 + mass / (1000.0 * 0.16 * 0.12),
              0.6 * kSpacing);
  EXPECT_EQ(probes.at("lost").back(), 0.0);
  ASSERT_EQ(bodies.at("time_s").size(), 51u) << "the tank alone: the box is not measured";
  EXPECT_NEAR(mean_of_second_half(bodies.at("fy_n")), -9.81 * mass, 0.005 * 9.81 * mass);

  const json summary = json::parse(read_text(file("out", "summary.json")));
  EXPECT_EQ(summary["particles"]["in_solids"], 0);
  EXPECT_EQ(summary["measured"]["bodies"][0]["name"], "tank");
  EXPECT_NEAR(summary["measured"]["bodies"][0]["mean_force_n"][1].get<double>(), -9.81 * mass,
              0.01 * 9.81 * mass);
  EXPECT_EQ(summary["measured"]["levels_m"][0]["name"], "middle");
  EXPECT_NE(outcome.out.find("middle: level"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("probes.csv"), std::string::npos);
}

TEST_F(MeasureTest, AnUnpacedRunIsTheSameAgainAndItsReplayMeasuresTheSame) {
  ASSERT_EQ(play("one", {"--threads", "1", "--record", "run.rec"}).code, 0);
  ASSERT_EQ(play("two", {"--threads", "2"}).code, 0);
  for (const char* name : {"wrenches.csv", "poses.csv", "bodies.csv", "probes.csv"}) {
    const std::string first = read_text(file("one", name));
    EXPECT_GT(first.size(), 1000u) << name;
    EXPECT_EQ(first, read_text(file("two", name))) << name;
  }
  const Outcome again = test::slosh({"replay", "run.rec", "--no-render", "--out", "again"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(read_text(file("one", "probes.csv")), read_text(file("again", "probes.csv")));
  EXPECT_EQ(read_text(file("one", "bodies.csv")), read_text(file("again", "bodies.csv")));
}

TEST_F(MeasureTest, WhoDoesNotAskGetsNothingAndWhoAsksGetsTheirInterval) {
  ASSERT_EQ(play("off", {"--measure", "0"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(file("off", "probes.csv")));
  EXPECT_FALSE(std::filesystem::exists(file("off", "bodies.csv")));
  ASSERT_EQ(play("coarse", {"--measure", "0.1"}).code, 0);
  EXPECT_EQ(columns_of(file("coarse", "probes.csv")).at("time_s").size(), 6u);
  EXPECT_EQ(play("no", {"--measure", "-1"}).code, 2);
}

TEST_F(MeasureTest, CheckSaysWhatIsMeasuredAtAnySpacing) {
  const Outcome coarse = test::slosh({"check", "measured.gltf"});
  const Outcome fine = test::slosh({"check", "measured.gltf", "--spacing", "0.006"});
  ASSERT_EQ(coarse.code, 0) << coarse.err;
  ASSERT_EQ(fine.code, 0) << fine.err;
  EXPECT_NE(coarse.out.find("1 bodies, 1 gauges, 1 regions"), std::string::npos) << coarse.out;
  EXPECT_NE(coarse.out.find("at 10.0 mm"), std::string::npos) << coarse.out;
  EXPECT_NE(fine.out.find("at 6.0 mm"), std::string::npos) << fine.out;
}

}  // namespace
}  // namespace slosh
