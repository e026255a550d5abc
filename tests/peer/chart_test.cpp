// Charts and maps: gnuplot takes what is written, whatever the texts are.
#include "peer/output/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

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
