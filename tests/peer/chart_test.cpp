// Charts and maps: gnuplot takes what is written, whatever the texts are.
#include "peer/output/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "peer/output/field_words.h"
#include "peer/output/gnuplot.h"

namespace slosh {
namespace {

constexpr const char* kHostile = "`touch owned` $(touch owned) \"x\" 'y' @m \\n |cat";

std::filesystem::path fresh(const char* name) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / name;
  std::filesystem::remove(file);
  return file;
}

void expect_picture(const std::string& script, const char* name) {
  const std::filesystem::path file = fresh(name);
  const Result<bool> drawn = draw(script, file);
  ASSERT_TRUE(drawn) << drawn.error().text();
  std::ifstream in(file, std::ios::binary);
  char head[4] = {};
  in.read(head, 4);
  EXPECT_EQ(std::string(head + 1, 3), "PNG");
  EXPECT_FALSE(std::filesystem::exists("owned"));
}

TEST(Chart, DrawsWhateverItIsGiven) {
  ChartPanel panel{kHostile, kHostile, kHostile, true, true, {}};
  panel.series.push_back(
      {kHostile, "#c8322b", {{1.0, 1.0}, {2.0, 0.5}, {0.0, 1.0}, {3.0, std::nan("")}}, 7, 1.0, 1.0, true});
  panel.series.push_back({"one point", "#1f5fbf", {{1.5, 2.0}}, 4, 2.0, 0.0, false});
  panel.series.push_back({"none that a logarithm has", "#1f5fbf", {{-1.0, 2.0}}, 4, 2.0, 0.0, false});
  const ChartPanel empty{"empty", "x", "y", true, true, {}};
  expect_picture(chart_script({panel, empty, panel}, 2, kHostile), "chart_test.png");
}

// What is left for curves is told by gnuplot itself: the axes' width and height on the picture.
TEST(Chart, ALegendOfLongNamesLeavesRoomForCurves) {
  for (const std::size_t names : {1u, 4u, 12u}) {
    ChartPanel panel{"t", "x", "y", false, false, {}};
    for (std::size_t i = 0; i < names; ++i)
      panel.series.push_back({std::string(60, 'n'), "#000000", {{0.0, 1.0}, {1.0, 2.0}}, 0, 1.0, 1.0, false});
    std::string script = chart_script({panel, panel}, 2, "t");
    const std::size_t end = script.rfind("unset multiplot");
    script.insert(end,
                  "if (GPVAL_TERM_XMAX - GPVAL_TERM_XMIN < 450) exit status 1\n"
                  "if (GPVAL_TERM_YMAX - GPVAL_TERM_YMIN < 250) exit status 1\n");
    expect_picture(script, "legend_test.png");
  }
}

// Curves of a run: nothing is before its first moment.
TEST(Chart, CurvesBeginAtTheAxis) {
  ChartPanel panel{"t", "time, s", "force, N", false, false, {}};
  panel.series.push_back({"a", "#000000", {{0.25, 10.0}, {4.5, 12.0}}, 0, 1.0, 1.6, false});
  panel.series.push_back({"b", "#000000", {{0.5, 11.0}, {4.0, 12.0}}, 0, 1.0, 1.6, false});
  std::string script = chart_script({panel}, 1, "t");
  script.insert(script.rfind("unset multiplot"),
                "if (GPVAL_X_MIN != 0.25) exit status 1\nif (GPVAL_X_MAX != 4.5) exit status 1\n");
  expect_picture(script, "range_test.png");
}

TEST(FieldWords, UnitsStandBehindTheNumber) {
  EXPECT_EQ(field_in_words("viscosity_pa_s", "0.5"), "viscosity = 0.5 Pa\xC2\xB7s");
  EXPECT_EQ(field_in_words("stiffness_n_m", "500"), "stiffness = 500 N/m");
  EXPECT_EQ(field_in_words("density_kg_m3", "998"), "density = 998 kg/m\xC2\xB3");
  EXPECT_EQ(field_in_words("rotational_stiffness_nm_rad", "2"), "rotational stiffness = 2 N\xC2\xB7m/rad");
  EXPECT_EQ(field_in_words("angular_velocity_rad_s", "2"), "angular velocity = 2 rad/s");
  EXPECT_EQ(field_in_words("stiffness_m2_s2", "400"), "stiffness = 400 m\xC2\xB2/s\xC2\xB2");
  EXPECT_EQ(field_in_words("mass_kg", "2"), "mass = 2 kg");
  EXPECT_EQ(field_in_words("model", "paper"), "model = paper");
  EXPECT_EQ(field_in_words("support_ratio", "2"), "support_ratio = 2");
}

TEST(Chart, LeavesOutWhatHasNoLogarithm) {
  ChartPanel panel{"t", "x", "y", true, true, {}};
  panel.series.push_back({"s", "#000000", {{-5.0, 1.0}, {4.25, 1.0}}, 7, 1.0, 0.0, false});
  const std::string script = chart_script({panel}, 1, "t");
  EXPECT_EQ(script.find("-5 1"), std::string::npos);
  EXPECT_NE(script.find("4.25 1"), std::string::npos);
}

/// What cannot be below nothing does not begin there.
TEST(Chart, AnAxisOfWhatBeginsAtNothingBeginsThere) {
  ChartPanel panel{"t", "x", "y", false, false, {}};
  panel.series.push_back({"s", "#000000", {{0.0, 1e-12}, {1.0, 2.0}}, 0, 1.0, 1.0, false});
  EXPECT_NE(chart_script({panel}, 1, "t").find("set yrange [0:*]"), std::string::npos);
  panel.series[0].points.push_back({2.0, -0.1});
  EXPECT_EQ(chart_script({panel}, 1, "t").find("set yrange [0:*]"), std::string::npos);
  panel.series[0].points = {{0.0, 5.0}, {1.0, 6.0}};
  EXPECT_EQ(chart_script({panel}, 1, "t").find("set yrange [0:*]"), std::string::npos) << "far from it";
  panel.y_from_zero = true;
  std::string script = chart_script({panel}, 1, "t");
  script.insert(script.rfind("unset multiplot"), "if (GPVAL_Y_MIN != 0) exit status 1\n");
  expect_picture(script, "zero_test.png");
}

/// Of a logarithmic axis no power of ten is empty, where two are left.
TEST(Chart, ALogarithmicAxisEndsWhereItsValuesDo) {
  ChartPanel panel{"t", "x", "y", true, true, {}};
  panel.series.push_back({"s", "#000000", {{2.0, 0.5}, {300.0, 0.7}}, 7, 1.0, 1.0, false});
  std::string script = chart_script({panel}, 1, "t");
  script.insert(script.rfind("unset multiplot"),
                "if (GPVAL_X_MIN < 1 || GPVAL_X_MAX > 500) exit status 1\n"
                "if (GPVAL_Y_MAX < 1) exit status 1\n");
  expect_picture(script, "logarithmic_test.png");
}

TEST(TileMap, DrawsWhateverItIsGiven) {
  TileMap map;
  map.title = kHostile;
  map.subtitle = std::string(400, 'x') + kHostile;
  map.rows = {kHostile, "second"};
  map.columns = {"a", kHostile};
  map.kinds = {{"good", "#00ff00"}, {kHostile, "#ff0000"}};
  map.kind = {{0, 1}, {-1, 0}};
  map.text = {{kHostile, ""}, {"", "2 % lost"}};
  expect_picture(tile_script(map), "tile_test.png");
}

}  // namespace
}  // namespace slosh
