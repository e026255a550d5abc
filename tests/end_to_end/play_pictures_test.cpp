// What `slosh play` draws: films, pictures of both eyes, caustics, the sheet of forces.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "peer/view/orbit_camera.h"
#include "play_kit.h"
#include "process.h"
#include "render/image.h"
#include "scenes/load.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::Outcome;
using test::PlayTest;
using test::probe;
using test::read_text;

TEST_F(PlayTest, SurfaceAndSheetAreAsAskedFor) {
  const Outcome outcome = test::slosh({"play", "probe", "--headless", "--seconds", "0.2", "--spacing",
                                       "0.012", "--size", "64x48", "--fps", "10", "--surface", "paper",
                                       "--plot", "svg", "--curves", "fy,torque", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string sheet = read_text(out() / "wrenches.svg");
  EXPECT_NE(sheet.find("force along y, N"), std::string::npos);
  EXPECT_NE(sheet.find("torque on the hand, N·m"), std::string::npos);
  EXPECT_EQ(sheet.find("force on the hand"), std::string::npos) << "not asked for";
  EXPECT_NE(sheet.find("spacing 12 mm"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out() / "wrenches.png"));
  EXPECT_EQ(probe(out() / "view.mp4", "color_space"), "bt709");
}

/// How far left the right half of a picture of both eyes has what the left half has round `pixel`, in pixels:
/// where a patch of 40 x 40 differs least.
int patch_apart(const Image& both, const glm::dvec2& pixel) {
  const int half = both.width / 2;
  const auto channel = [&](int x, int y, int c) {
    const auto at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(both.width) + static_cast<std::size_t>(x);
    return int{both.rgba[4 * at + static_cast<std::size_t>(c)]};
  };
  int best = 0;
  long least = -1;
  for (int apart = -40; apart <= 40; ++apart) {
    long sum = 0;
    for (int y = static_cast<int>(pixel.y) - 20; y < static_cast<int>(pixel.y) + 20; ++y) {
      for (int x = static_cast<int>(pixel.x) - 20; x < static_cast<int>(pixel.x) + 20; ++x) {
        for (int c = 0; c < 3; ++c) sum += std::abs(channel(x, y, c) - channel(half + x - apart, y, c));
      }
    }
    if (least >= 0 && sum >= least) continue;
    least = sum;
    best = apart;
  }
  return best;
}

// Light that a wavy surface gathers is seen where it was asked for, at the quality that has it, and nowhere
// else.
TEST_F(PlayTest, CausticsAreThereWhereTheyAreAskedFor) {
  std::string said;
  const auto drawn = [&](const std::string& folder, std::vector<std::string> looks) {
    std::vector<std::string> command{"play",      "pool", "--headless", "--seconds", "0.3",
                                     "--spacing", "0.05", "--size",     "640x480",   "--unpaced",
                                     "--out",     folder, "--fps",      "10"};
    command.insert(command.end(), looks.begin(), looks.end());
    const Outcome outcome = test::slosh(command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    said = outcome.err;
    const Result<Image> picture = read_png(out().parent_path() / folder / "final.png");
    EXPECT_TRUE(picture) << picture.error().text();
    // Right of the panels, which say how long a step took.
    std::vector<std::uint8_t> right;
    for (int y = 0; picture && y < 480; ++y) {
      const auto row = picture.value().rgba.begin() + 4 * 640 * y;
      right.insert(right.end(), row + 4 * 240, row + 4 * 640);
    }
    return right;
  };
  const auto fast = drawn("fast", {"--quality", "fast"});
  EXPECT_TRUE(fast == drawn("fast_asked", {"--quality", "fast", "--caustics"})) << "only at full quality";
  EXPECT_NE(
      said.find("slosh: --caustics: there are none with --quality fast; the picture is drawn without them"),
      std::string::npos)
      << said;
  const auto full = drawn("full", {"--quality", "full"});
  const auto lit = drawn("lit", {"--caustics"});
  EXPECT_EQ(said.find("slosh: --caustics"), std::string::npos) << said << ": it asks for full quality itself";
  ASSERT_EQ(full.size(), lit.size());
  std::size_t other = 0;
  for (std::size_t i = 0; i < full.size(); ++i) other += std::abs(int{full[i]} - int{lit[i]}) > 4;
  std::printf("caustics change %zu of %zu channels by more than 4\n", other, full.size());
  EXPECT_GT(other, full.size() / 400);
}

TEST_F(PlayTest, AFilmInBothEyesDiffersAsFarAsEyesAreApart) {
  const Outcome outcome =
      test::slosh({"play", "probe", "--headless", "--seconds", "0.2", "--spacing", "0.012", "--size",
                   "640x480", "--fps", "10", "--stereo", "--unpaced", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(probe(out() / "view.mp4", "width"), "1280");
  EXPECT_EQ(probe(out() / "view.mp4", "nb_read_frames"), "3");
  EXPECT_EQ(json::parse(read_text(out() / "summary.json"))["render"]["width"], 1280);
  const Result<Image> last = read_png(out() / "final.png");
  ASSERT_TRUE(last) << last.error().text();
  ASSERT_EQ(last.value().width, 1280);
  // The tank's near and its far foot, by similar triangles: what the camera looks at lies in the screen.
  const Result<Scene> scene = load_scene(find_scene("probe").value());
  ASSERT_TRUE(scene) << scene.error().text();
  const OrbitCamera camera(scene.value().camera);
  const TriangleMesh& tank = scene.value().meshes[static_cast<std::size_t>(scene.value().bodies[0].mesh)];
  glm::dvec3 near(0.0);
  for (const auto& p : tank.positions) near = glm::max(near, glm::dvec3(p));
  near.y = 0.0;
  const glm::dvec3 far(-near.x, 0.0, near.z);
  const double pixels = 480.0 / camera.height_at_target() * camera.distance();  // of a metre, a metre away
  for (const glm::dvec3& foot : {near, far}) {
    const double expected = pixels * 0.063 * (1.0 / camera.depth_of(foot) - 1.0 / camera.distance());
    const glm::dvec2 left = camera.pixel_of(foot, {640, 480}) + glm::dvec2(0.5 * expected, 0.0);
    EXPECT_NEAR(patch_apart(last.value(), left), expected, 1.5) << foot.x;
  }
}

}  // namespace
}  // namespace slosh
