// `slosh play` in a window on a virtual display, with real events of mouse and keys: GLFW, ImGui and all
// below them.
#include "window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "process.h"
#include "render/image.h"

namespace slosh {
namespace {

using test::Outcome;
using test::Process;
using test::read_text;

TEST_F(WindowTest, AMousePoursTheDefaultBucket) {
  Process slosh(display->on({test::program(), "play", "bucket", "--spacing", "0.012", "--size",
                             std::to_string(kWidth) + "x" + std::to_string(kHeight), "--measure", "0.05",
                             "--out", "out"}),
                test::test_folder());
  ASSERT_TRUE(comes([&] { return !slosh.running() || rows() > 50; }));
  ASSERT_TRUE(slosh.running()) << read_text(test::test_folder() / "stderr.txt");

  // On the bucket's front, below its rim: both hands at once.
  const glm::ivec2 bucket = pixel({0.0, 0.36, 0.09});
  display->act({"mousemove", std::to_string(bucket.x), std::to_string(bucket.y), "mousedown", "1",
                "mousemove_relative", "--", "160", "0"});
  ASSERT_TRUE(comes([&] { return newest(0).position.x > -0.143 + 0.05; })) << "dragged to the right";
  display->act({"click", "--repeat", "24", "--delay", "30", "4"});
  EXPECT_TRUE(comes([&] { return glm::length(turn_of(newest(0))) > 1.6; }))
      << "24 notches of 4°: well beyond what the script tilts";
  const Pose left = newest(0);
  const Pose right = newest(1);
  EXPECT_NEAR(glm::distance(left.position, right.position), 0.286, 0.02) << "the hands go as one";
  EXPECT_LT(glm::length(rotation_between(left.orientation, right.orientation)), 0.1);
  EXPECT_GT(turn_of(left).z, 1.4) << "rad, to the left; the camera looks from beside";

  display->act({"key", "p"});
  EXPECT_TRUE(comes([&] { return std::filesystem::exists(out / "picture-1.png"); }));
  display->act({"mouseup", "1"});
  display->act({"key", "b"});
  EXPECT_TRUE(comes([&] { return glm::length(turn_of(newest(0))) < 1.0; })) << "the script has them again";
  display->act({"key", "q"});
  const Outcome outcome = slosh.wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(read_png(out / "picture-1.png"));
  ASSERT_TRUE(std::filesystem::exists(out / "view.mp4"));
  EXPECT_GT(std::filesystem::file_size(out / "view.mp4"), 10000u) << "bytes: the film of it";

  // Four fifths of the water lies on the table or went over its edge: its middle is far below where it was.
  std::ifstream probes(out / "probes.csv");
  std::string header, line, last, first;
  std::getline(probes, header);
  while (std::getline(probes, line)) {
    if (first.empty()) first = line;
    last = line;
  }
  const auto height = [](const std::string& row) {
    std::stringstream in(row);
    std::string field;
    for (int i = 0; i < 8; ++i) std::getline(in, field, ',');
    return std::stod(field);
  };
  ASSERT_NE(header.find("time_s,particles,spilled,lost,in_solids,mass_kg,cx_m,cy_m"), std::string::npos)
      << header;
  EXPECT_GT(height(first), 0.33);
  EXPECT_LT(height(last), 0.2);
}

TEST_F(WindowTest, KeysPauseStepAndSlowTheWorld) {
  Process slosh(display->on({test::program(), "play", "bucket", "--spacing", "0.012", "--size", "320x240",
                             "--out", "out"}),
                test::test_folder());
  ASSERT_TRUE(comes([&] { return !slosh.running() || rows() > 50; }));
  ASSERT_TRUE(slosh.running()) << read_text(test::test_folder() / "stderr.txt");
  display->act({"mousemove", "160", "200"});
  display->act({"key", "space"});
  std::size_t before = 0;
  // A world that stands writes no rows: as many a second later as now.
  EXPECT_TRUE(comes([&] {
    before = rows();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    return rows() == before;
  }));
  display->act({"key", "n"});
  display->act({"key", "space"});
  EXPECT_TRUE(comes([&] { return rows() > before + 50; })) << "it goes on";
  for (int i = 0; i < 4; ++i) display->act({"key", "Down"});
  // The world starts again, and what was written before stays.
  const Result<std::vector<PoseKey>> earlier = read_poses(out / "poses.csv", 0);
  ASSERT_TRUE(earlier);
  display->act({"key", "r"});
  EXPECT_TRUE(comes([&] { return rows() > earlier.value().size() + 50; }));
  const Result<std::vector<PoseKey>> later = read_poses(out / "poses.csv", 0);
  ASSERT_TRUE(later) << later.error().text();
  for (std::size_t i = 0; i < earlier.value().size(); i += 10)
    EXPECT_EQ(later.value()[i].time, earlier.value()[i].time);
  for (std::size_t i = 1; i < later.value().size(); ++i)
    EXPECT_LT(later.value()[i - 1].time, later.value()[i].time);
  display->act({"key", "h"});
  display->act({"key", "Tab"});
  display->act({"key", "p"});
  EXPECT_TRUE(comes([&] { return std::filesystem::exists(out / "picture-1.png"); }));
  display->act({"key", "Escape"});
  EXPECT_EQ(slosh.wait().code, 0);
}

/// The knobs of the sliders in a picture, from the first down: a few rows of one blue each. Pixels.
std::vector<glm::ivec2> slider_knobs(const Image& picture) {
  std::vector<glm::ivec2> knobs;
  for (int y = 0; y < picture.height; ++y) {
    int first = -1, last = -1;
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* p = &picture.rgba[4 * static_cast<std::size_t>(y * picture.width + x)];
      if (std::abs(p[0] - 61) > 20 || std::abs(p[1] - 133) > 20 || std::abs(p[2] - 224) > 20) continue;
      if (first < 0) first = x;
      last = x;
    }
    if (last - first < 5 || last - first > 30) continue;
    if (knobs.empty() || y > knobs.back().y + 15) knobs.emplace_back((first + last) / 2, y + 4);
  }
  return knobs;
}

/// A slider is dragged, and the hands feel it: without gravity they carry nothing.
TEST_F(WindowTest, ASliderChangesTheWorldThatRuns) {
  Process slosh(display->on({test::program(), "play", "bucket", "--spacing", "0.0135", "--size", "640x480",
                             "--out", "out"}),
                test::test_folder());
  ASSERT_TRUE(comes([&] { return !slosh.running() || rows() > 50; }));
  ASSERT_TRUE(slosh.running()) << read_text(test::test_folder() / "stderr.txt");
  // N, of the left hand: the newest row's.
  const auto weight = [&] {
    const std::string text = read_text(out / "wrenches.csv");
    const std::size_t end = text.rfind("\n");
    if (end == std::string::npos || end == 0) return 0.0;
    std::stringstream row(text.substr(text.rfind("\n", end - 1) + 1));
    std::string field;
    for (int i = 0; i < 4; ++i) std::getline(row, field, ',');
    return std::atof(field.c_str());
  };
  EXPECT_LT(weight(), -9.0) << "it hangs on both hands";
  display->act({"mousemove", "320", "200"});
  display->act({"key", "Tab"});
  std::vector<glm::ivec2> knobs;
  for (int i = 1; i <= 5 && knobs.size() < 6; ++i) {
    const std::string name = "picture-" + std::to_string(i) + ".png";
    display->act({"key", "p"});
    ASSERT_TRUE(comes([&] { return static_cast<bool>(read_png(out / name)); })) << name;
    knobs = slider_knobs(read_png(out / name).value());
  }
  ASSERT_EQ(knobs.size(), 6u) << "pace, filter, gravity, viscosity of the water, stiffness of two hands";
  const glm::ivec2 gravity = knobs[2];
  // Between two pictures, or over several: a drag begins where it was pressed, and arrives where it stops.
  display->act({"mousemove", std::to_string(gravity.x), std::to_string(gravity.y), "mousedown", "1",
                "mousemove_relative", "--", "-85", "0"});
  EXPECT_TRUE(comes([&] { return std::abs(weight()) < 1.0; })) << weight() << " N";
  display->act({"mouseup", "1"});
  display->act({"key", "q"});
  EXPECT_EQ(slosh.wait().code, 0);
}

/// R begins the world again and takes nothing from what is being written: tables, frames, a recording, and
/// the film of it.
TEST_F(WindowTest, BeginningAgainKeepsTheTimeBeforeIt) {
  Process slosh(display->on({test::program(), "play", "bucket", "--spacing", "0.0135", "--size", "320x240",
                             "--out", "out", "--record", "r.rec", "--measure", "0.05", "--export",
                             "particles:ply", "--export-rate", "5"}),
                test::test_folder());
  ASSERT_TRUE(comes([&] { return !slosh.running() || rows() > 1000; }));
  ASSERT_TRUE(slosh.running()) << read_text(test::test_folder() / "stderr.txt");
  const std::vector<std::string> tables{"poses.csv", "wrenches.csv", "probes.csv", "bodies.csv",
                                        "frames/frames.csv"};
  std::vector<std::string> before;
  for (const std::string& table : tables) {
    const std::string text = read_text(out / table);
    before.push_back(text.substr(0, text.rfind('\n') + 1));
  }
  const std::string frame = read_text(out / "frames/particles_00000.ply");
  const std::size_t rows_before = rows();
  display->act({"mousemove", "160", "60"});
  display->act({"key", "r"});
  ASSERT_TRUE(comes([&] { return rows() > rows_before + 1000; }));
  display->act({"key", "r"});
  const std::size_t rows_between = rows();
  ASSERT_TRUE(comes([&] { return rows() > rows_between + 500; }));
  display->act({"key", "q"});
  const Outcome outcome = slosh.wait();
  ASSERT_EQ(outcome.code, 0) << outcome.err;

  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string after = read_text(out / tables[i]);
    EXPECT_GT(before[i].size(), 20u) << tables[i];
    EXPECT_GT(after.size(), before[i].size()) << tables[i];
    EXPECT_TRUE(after.starts_with(before[i]))
        << tables[i] << ": what stood there before R is not there any more";
  }
  EXPECT_EQ(read_text(out / "frames/particles_00000.ply"), frame);
  const Result<std::vector<PoseKey>> keys = read_poses(out / "poses.csv", 0);
  ASSERT_TRUE(keys) << keys.error().text();
  const double seconds = keys.value().back().time;
  EXPECT_GT(seconds, 2.4) << "s: 1 before the first R, 1 between them, half a second after";
  // The window's own film runs by the clock on the wall: no shorter than the world's time, but for gaps in
  // the drawing.
  const Outcome film =
      Process({"ffprobe", "-v", "error", "-show_entries", "format=duration", "-of", "csv=p=0", "view.mp4"},
              out)
          .wait();
  ASSERT_EQ(film.code, 0) << film.err;
  EXPECT_GT(std::stod(film.out), 0.7 * seconds);

  // The recording has all of it, both beginnings too, and the film of it is as long as the whole.
  const Outcome again =
      Process({test::program(), "replay", "../r.rec", "--out", "film", "--size", "160x120", "--fps", "10"},
              test::test_folder() / "again")
          .wait();
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find("hashes agree"), std::string::npos) << again.out;
  std::smatch pictures;
  ASSERT_TRUE(std::regex_search(again.out, pictures, std::regex("(\\d+) pictures of"))) << again.out;
  EXPECT_NEAR(std::stod(pictures[1]), 10.0 * seconds, 3.0) << "pictures, 10 a second";
}

/// Keys of the settings file, particles by speed, axes and the plot of forces; the pictures are there to be
/// looked at.
TEST_F(WindowTest, KeysOfTheSettingsShowWhatIsMeasured) {
  std::ofstream(test::test_folder() / "settings.toml")
      << "[keys]\npause = \"K\"\nparticles = \"M\"\nend = \"F10\"\n";
  std::vector<std::string> words =
      display->on({"SLOSH_SETTINGS=settings.toml", test::program(), "play", "bucket", "--spacing", "0.012",
                   "--size", "640x480", "--out", "out"});
  Process slosh(words, test::test_folder());
  ASSERT_TRUE(comes([&] { return !slosh.running() || rows() > 50; }));
  ASSERT_TRUE(slosh.running()) << read_text(test::test_folder() / "stderr.txt");
  display->act({"mousemove", "320", "60"});
  const auto picture = [&](const std::string& name) {
    display->act({"key", "p"});
    EXPECT_TRUE(comes([&] { return static_cast<bool>(read_png(out / name)); })) << name;
    const Result<Image> read = read_png(out / name);
    return read ? read.value() : Image{};
  };
  const Image plain = picture("picture-1.png");
  for (const char* key : {"m", "x", "f"}) display->act({"key", key});
  const Image measured = picture("picture-2.png");
  ASSERT_EQ(plain.rgba.size(), measured.rgba.size());
  std::size_t differ = 0;
  for (std::size_t i = 0; i < plain.rgba.size(); i += 4) {
    int by = 0;
    for (std::size_t c = 0; c < 3; ++c) by = std::max(by, std::abs(plain.rgba[i + c] - measured.rgba[i + c]));
    differ += by > 40;
  }
  EXPECT_GT(differ, plain.rgba.size() / 4 / 20) << "of " << plain.rgba.size() / 4 << " pixels";
  display->act({"key", "q"});
  display->act({"key", "Escape"});
  display->act({"key", "h"});
  picture("picture-3.png");
  EXPECT_TRUE(slosh.running()) << "neither ends it any more";
  display->act({"key", "F10"});
  EXPECT_EQ(slosh.wait().code, 0);
}

}  // namespace
}  // namespace slosh
