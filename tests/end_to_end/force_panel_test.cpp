// The window's plot of forces by real clicks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "render/image.h"
#include "sim/math/format.h"
#include "window.h"

namespace slosh {
namespace {

using test::Outcome;
using test::Process;
using test::read_text;

using ForcePanelTest = WindowTest;

/// Of the panel of forces, where it is first shown in a window of kWidth × kHeight: the middles of the blue
/// boxes of its first row, which are hold's and save's; pixels.
std::vector<glm::ivec2> boxes_of_forces(const Image& picture) {
  constexpr int kRow = 238;
  std::vector<glm::ivec2> boxes;
  int first = -1;
  for (int x = 282; x < picture.width; ++x) {
    const std::uint8_t* p = &picture.rgba[4 * static_cast<std::size_t>((kRow - 6) * picture.width + x)];
    const bool blue = p[2] > p[0] + 30 && p[2] > 60;  // above a box's letters
    if (blue && first < 0) first = x;
    if (blue || first < 0) continue;
    if (x - first > 10) boxes.emplace_back((first + x) / 2, kRow);
    first = -1;
  }
  return boxes;
}

/// Whether a box has its tick, which is brighter than any box.
bool ticked(const Image& picture, glm::ivec2 box) {
  int bright = 0;
  for (int y = box.y - 7; y < box.y + 7; ++y) {
    for (int x = box.x - 7; x < box.x + 7; ++x)
      bright += picture.rgba[4 * static_cast<std::size_t>(y * picture.width + x) + 2] > 200;
  }
  return bright > 8;
}

/// Which pixels of its plot of force are curves: all else there is dark.
std::vector<bool> curves_of_forces(const Image& picture) {
  std::vector<bool> out;
  for (int y = 268; y < 312; ++y) {
    for (int x = 292; x < 622; ++x) {
      const std::uint8_t* p = &picture.rgba[4 * static_cast<std::size_t>(y * picture.width + x)];
      out.push_back(std::max(p[0], p[2]) > 140);
    }
  }
  return out;
}

/// The share of what either shows that the other does not.
double apart(const std::vector<bool>& a, const std::vector<bool>& b) {
  double differ = 0.0, any = 1e-9;
  for (std::size_t i = 0; i < a.size(); ++i) {
    differ += a[i] != b[i];
    any += a[i] || b[i];
  }
  return differ / any;
}

/// The plot of forces by clicks: held while the world goes on, dragged back in time, zoomed, saved, let go.
/// The right hand is behind it: no drag in the panel takes hold of that.
TEST_F(ForcePanelTest, ClicksHoldAndSaveThePlot) {
  Process slosh(display->on({test::program(), "play", "bucket", "--spacing", "0.0135", "--size",
                             std::to_string(kWidth) + "x" + std::to_string(kHeight), "--out", "out"}),
                test::test_folder());
  ASSERT_TRUE(comes([&] { return !slosh.running() || rows() > 3000; })) << "3 s: tilted to the left";
  ASSERT_TRUE(slosh.running()) << read_text(test::test_folder() / "stderr.txt");
  int pictures = 0;
  const auto picture = [&] {
    const std::string name = format("picture-%d.png", ++pictures);
    display->act({"key", "p"});
    EXPECT_TRUE(comes([&] { return static_cast<bool>(read_png(out / name)); })) << name;
    const Result<Image> read = read_png(out / name);
    return read ? read.value() : Image{};
  };
  const auto later = [&](std::size_t milliseconds) {
    const std::size_t before = rows();
    EXPECT_TRUE(comes([&] { return rows() > before + milliseconds; }));
  };
  // A click that is over before a picture was drawn is none for Dear ImGui 1.86; a machine that does other
  // things draws few.
  const auto click = [&](glm::ivec2 at) {
    point(at);
    display->act({"sleep", "0.4", "mousedown", "1", "sleep", "0.4", "mouseup", "1", "sleep", "0.4"});
  };
  point({100, 60});
  display->act({"key", "f"});
  std::vector<glm::ivec2> boxes;
  for (int i = 0; i < 5 && boxes.size() < 2; ++i) boxes = boxes_of_forces(picture());
  ASSERT_EQ(boxes.size(), 2u) << "hold and save";

  const auto hold = [&](bool wanted) {
    for (int i = 0; i < 5; ++i) {
      if (ticked(picture(), boxes[0]) == wanted) return true;
      click(boxes[0]);
    }
    return ticked(picture(), boxes[0]) == wanted;
  };

  ASSERT_TRUE(hold(true));
  const std::vector<bool> held = curves_of_forces(picture());
  later(700);
  EXPECT_LT(apart(held, curves_of_forces(picture())), 0.05) << "it stands while the world goes on";
  const glm::ivec2 inside{380, 290};
  point(inside);
  display->act({"mousedown", "1"});
  for (int i = 1; i <= 8; ++i) {
    point(inside + glm::ivec2(10 * i, 0));
    display->act({"sleep", "0.1"});
  }
  display->act({"mouseup", "1", "sleep", "0.4"});
  point({100, 60});
  const std::vector<bool> back = curves_of_forces(picture());
  EXPECT_GT(apart(held, back), 0.3) << "dragged back in time";
  point(inside);
  display->act({"click", "--repeat", "4", "--delay", "100", "4", "sleep", "0.4"});
  point({100, 60});
  const std::vector<bool> zoomed = curves_of_forces(picture());
  EXPECT_GT(apart(back, zoomed), 0.3) << "zoomed by four notches";
  EXPECT_TRUE(comes([&] {
    click(boxes[1]);
    return std::filesystem::exists(out / "forces-1.csv");
  })) << "saved";
  ASSERT_TRUE(hold(false));
  point({100, 60});
  later(500);
  EXPECT_GT(apart(zoomed, curves_of_forces(picture())), 0.3) << "let go it shows what is felt now";
  display->act({"key", "q"});
  EXPECT_EQ(slosh.wait().code, 0);

  // What was saved is what the hands felt: at first the weight of bucket and water, 31.17 N.
  std::istringstream table(read_text(out / "forces-1.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_TRUE(line.starts_with("time_s,left_hand_fx_n,left_hand_fy_n,left_hand_fz_n,left_hand_tx_nm"))
      << line;
  int at_rest = 0;
  double last = 0.0;
  while (std::getline(table, line)) {
    std::vector<double> row;
    std::stringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) row.push_back(std::stod(field));
    ASSERT_EQ(row.size(), 13u) << "time, and force and torque of two hands";
    last = row[0];
    if (last > 0.9) continue;  // s, then the tilting begins
    EXPECT_NEAR(row[2] + row[8], -31.17, 0.2) << last << " s";
    ++at_rest;
  }
  EXPECT_GT(at_rest, 0) << "one a picture, and a busy machine draws two in that time";
  EXPECT_GT(last, 3.0) << "s: held still it goes on taking down what is felt";
  // The script had both hands all the time: it moves them in one plane, and a drag would not.
  for (const int hand : {0, 1}) {
    const Result<std::vector<PoseKey>> keys = read_poses(out / "poses.csv", hand);
    ASSERT_TRUE(keys) << keys.error().text();
    double sideways = 0.0;
    for (const PoseKey& key : keys.value()) sideways = std::max(sideways, std::abs(key.pose.position.z));
    EXPECT_LT(sideways, 1e-6) << "m";
  }
}

}  // namespace
}  // namespace slosh
