// A scene with instruments, from its file to bodies.csv and probes.csv.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
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
  static constexpr double kGauge = 0.05;  // m above the tank's foot, 0.02 above its floor

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
    writer.add_node("middle", -1, {{0.0, kGauge, 0.0}, {1, 0, 0, 0}}, {{"slosh", "gauge"}});
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
  const double head = 1000.0 * 9.81 * (0.03 + mass / (1000.0 * 0.16 * 0.12) - kGauge);
  EXPECT_NEAR(mean_of_second_half(probes.at("middle_pressure_pa")), head, 0.1 * head);
  EXPECT_EQ(probes.at("lost").back(), 0.0);
  ASSERT_EQ(bodies.at("time_s").size(), 51u) << "the tank alone: the box is not measured";
  // 0.51 % in the quarter of a second that is taken: it still swings.
  EXPECT_NEAR(mean_of_second_half(bodies.at("fy_n")), -9.81 * mass, 0.007 * 9.81 * mass);

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

// A box glued to the tank that a hand pulls off: told by check, written, and the same in a replay.
TEST_F(MeasureTest, AJointThatBreaksIsWritten) {
  json scene = json::parse(read_text(test::test_folder() / "measured.gltf"));
  for (json& node : scene["nodes"])
    if (node["name"] == "box") node["children"].push_back(scene["nodes"].size());
  scene["nodes"].push_back(
      {{"name", "glue"},
       {"extras", {{"slosh", "joint"}, {"kind", "fixed"}, {"to", "tank"}, {"breaks_n", 3.0}}}});
  std::ofstream(test::test_folder() / "measured.gltf") << scene.dump();
  const Outcome check = test::slosh({"check", "measured.gltf"});
  EXPECT_NE(check.out.find("glue: fixed of box and tank, breaks above 3 N"), std::string::npos) << check.out;
  ASSERT_EQ(play("glued", {"--record", "glued.rec"}).code, 0);
  const auto probes = columns_of(file("glued", "probes.csv"));
  const std::vector<double>& joined = probes.at("glue_joined");
  EXPECT_EQ(joined.front(), 1.0);
  EXPECT_EQ(joined.back(), 0.0);
  const auto broke = std::find(joined.begin(), joined.end(), 0.0) - joined.begin();
  const std::vector<double>& force = probes.at("glue_force_n");
  EXPECT_LE(*std::max_element(force.begin(), force.begin() + broke), 3.0);
  EXPECT_GT(force[static_cast<std::size_t>(broke)], 3.0);
  EXPECT_EQ(force.back(), 0.0);
  EXPECT_EQ(probes.count("glue_angle_rad") + probes.count("glue_way_m"), 0u);
  ASSERT_EQ(test::slosh({"replay", "glued.rec", "--no-render", "--out", "again"}).code, 0);
  EXPECT_EQ(read_text(file("glued", "probes.csv")), read_text(file("again", "probes.csv")));
}

TEST_F(MeasureTest, WhoDoesNotAskGetsNothingAndWhoAsksGetsTheirInterval) {
  ASSERT_EQ(play("off", {"--measure", "0"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(file("off", "probes.csv")));
  EXPECT_FALSE(std::filesystem::exists(file("off", "bodies.csv")));
  ASSERT_EQ(play("coarse", {"--measure", "0.1"}).code, 0);
  EXPECT_EQ(columns_of(file("coarse", "probes.csv")).at("time_s").size(), 6u);
  EXPECT_EQ(play("no", {"--measure", "-1"}).code, 2);
}

TEST_F(MeasureTest, AHostMeasuresTooAndCarriesOnInAFolderOfItsOwn) {
  const std::vector<std::string> host{"host",     "measured.gltf", "--wait",    "0", "--seconds", "0.2",
                                      "--listen", "127.0.0.1:0",   "--threads", "1", "--out",     "hosted"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = host;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::slosh(arguments);
  };
  const std::string kept = (test::test_folder() / "world.checkpoint").string();
  const Outcome outcome = with({"--checkpoint", kept});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("measured   "), std::string::npos) << outcome.out;
  const auto probes = columns_of(file("hosted", "probes.csv"));
  EXPECT_GE(probes.at("time_s").size(), 20u) << "a row each 0.01 s, and the first";
  EXPECT_EQ(probes.at("lost").back(), 0.0);
  EXPECT_EQ(probes.count("middle_pressure_pa"), 1u);
  EXPECT_GE(columns_of(file("hosted", "bodies.csv")).at("time_s").size(), 20u);

  const std::string before = read_text(file("hosted", "probes.csv"));
  const Outcome refused = with({"--checkpoint", "none"});
  EXPECT_EQ(refused.code, 1) << "the tables of an earlier run are not lost";
  const Outcome again = test::slosh({"host", "--resume", kept, "--seconds", "0.3", "--wait", "0", "--listen",
                                     "127.0.0.1:0", "--threads", "1", "--out", "hosted"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(read_text(file("hosted", "probes.csv")), before);
  const auto later = columns_of(file("hosted-2", "probes.csv"));
  EXPECT_NEAR(later.at("time_s").front(), 0.2, 0.01) << "on from where it was saved";
  EXPECT_NEAR(later.at("time_s").back(), 0.3, 0.01);
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

// What the fluid starts with is there at t = 0 where the scene asks for no settling; else it has come to
// rest.
class StartsTest : public ::testing::Test {
 protected:
  using Columns = std::map<std::string, std::vector<double>>;

  void SetUp() override {
    std::filesystem::remove_all(test::test_folder());
    std::filesystem::create_directories(test::test_folder());
  }
  /// A tank of 0.24 x 0.08 m, its floor at y = 0.
  static make::SceneWriter tank(double settle) {
    json extras{{"title", "starts"}, {"spacing_m", 0.01}, {"duration_s", 0.02}};
    if (settle >= 0.0) extras["settle_s"] = settle;
    make::SceneWriter writer(extras);
    const int paint = writer.add_material("paint", {});
    writer.add_node("tank", writer.add_mesh("tank", make::tank({0.24, 0.16, 0.08}, 0.03), paint),
                    {{0.0, -0.03, 0.0}, {1, 0, 0, 0}}, {{"slosh", "body"}});
    return writer;
  }
  static void add_fluid(make::SceneWriter& writer, const std::string& name, const glm::dvec3& low,
                        const glm::dvec3& high, double density) {
    writer.add_node(name, writer.add_mesh(name, make::box(low, high), 0), {},
                    {{"slosh", "fluid"}, {"density_kg_m3", density}, {"viscosity_pa_s", 0.01}});
  }
  /// The first row of probes.csv; `said` receives what check and plan say of it.
  static Columns first_rows(make::SceneWriter writer, std::string& said) {
    EXPECT_TRUE(writer.write(test::test_folder() / "starts.gltf"));
    const Outcome played = test::slosh(
        {"play", "starts.gltf", "--headless", "--no-render", "--unpaced", "--overwrite", "--out", "out"});
    EXPECT_EQ(played.code, 0) << played.err;
    said = test::slosh({"check", "starts.gltf"}).out + test::slosh({"plan", "starts.gltf"}).out;
    return columns_of(test::test_folder() / "out" / "probes.csv");
  }
  static void expect_said(const std::string& said, const char* words) {
    const std::size_t in_check = said.find(words);
    ASSERT_NE(in_check, std::string::npos) << said;
    EXPECT_NE(said.find(words, in_check + 1), std::string::npos) << "in plan too: " << said;
  }
};

TEST_F(StartsTest, AHeadDifferenceIsThereWhereNothingSettles) {
  const auto run = [](double settle, std::string& said) {
    make::SceneWriter writer = tank(settle);
    add_fluid(writer, "high", {-0.12, 0.0, -0.04}, {0.0, 0.10, 0.04}, 1000.0);
    add_fluid(writer, "low", {0.0, 0.0, -0.04}, {0.12, 0.05, 0.04}, 1000.0);
    writer.add_node("left", -1, {{-0.06, 0.0, 0.0}, {1, 0, 0, 0}}, {{"slosh", "gauge"}});
    writer.add_node("right", -1, {{0.06, 0.0, 0.0}, {1, 0, 0, 0}}, {{"slosh", "gauge"}});
    const Columns rows = first_rows(std::move(writer), said);
    return rows.at("left_level_m").front() - rows.at("right_level_m").front();
  };
  std::string said;
  EXPECT_NEAR(run(0.0, said), 0.05, 1e-3);
  expect_said(said, "starts as the scene has it");
  EXPECT_LT(run(-1.0, said), 0.02) << "where nothing is said, it is nearly level";
  expect_said(said, "settles 1 s before the run");
  EXPECT_LT(run(1.0, said), 0.02) << "asked to settle, it is nearly level";
  expect_said(said, "settles 1 s before the run");
}

TEST_F(StartsTest, AHeavyFluidOverALightOneIsThereUnlessItIsAskedToSettle) {
  double light = 0.0;
  const auto run = [&](double settle, std::string& said) {
    make::SceneWriter writer = tank(settle);
    add_fluid(writer, "light", {-0.12, 0.0, -0.04}, {0.12, 0.05, 0.04}, 1000.0);
    add_fluid(writer, "heavy", {-0.12, 0.05, -0.04}, {0.12, 0.10, 0.04}, 3000.0);
    const int mesh = writer.add_mesh("lower", make::box({-0.2, -0.05, -0.2}, {0.2, 0.05, 0.2}), 0);
    writer.add_node("lower", mesh, {}, {{"slosh", "region"}});
    const Columns rows = first_rows(std::move(writer), said);
    if (settle == 0.0) light = 0.25 * rows.at("mass_kg").front();  // half the particles, a third as heavy
    return rows.at("lower_mass_kg").front();
  };
  std::string said;
  const double below = run(0.0, said);
  EXPECT_GT(light, 0.5);
  EXPECT_NEAR(below, light, 1e-6) << "nothing heavy is below";
  EXPECT_GT(run(1.0, said), 1.2 * light) << "asked to settle, some of it has sunk";
}

}  // namespace
}  // namespace slosh
