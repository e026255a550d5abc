// What only shows when a scene is sampled.
#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/sample.h"
#include "support.h"

namespace slosh {
namespace {

Scene load_cup(const make::Solid* cup, const make::Solid* water) {
  const test::TempFolder folder;
  EXPECT_TRUE(test::make_cup({{"title", "x"}}, cup, water).write(folder / "cup.gltf"));
  auto scene = load_scene(folder / "cup.gltf");
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? std::move(scene.value()) : Scene{};
}

TEST(SampleErrors, FluidThatOverlapsAWall) {
  const make::Solid water = make::box({-0.06, 0.01, -0.06}, {0.06, 0.09, 0.06});
  test::expect_error(sample_scene(load_cup(nullptr, &water), 0.008),
                     {"cup.gltf", "'water'", "'cup'", "overlaps", "%"});
}

TEST(SampleErrors, SpacingAboveTheWall) {
  const make::Solid cup = make::tank({0.1, 0.1, 0.1}, 0.006);
  const Scene scene = load_cup(&cup, nullptr);
  std::size_t body = 99;
  EXPECT_NEAR(thinnest_wall(scene, &body), 0.006, 1e-5);
  EXPECT_EQ(body, 0u);
  test::expect_error(sample_scene(scene, 0.01),
                     {"cup.gltf", "'cup'", "6 mm", "10 mm", "spacing_max_m", "thicken"});
}

TEST(SampleErrors, NoRoomForAParticle) {
  const make::Solid water = make::box({-0.003, 0.02, -0.003}, {0.003, 0.026, 0.003});
  test::expect_error(sample_scene(load_cup(nullptr, &water), 0.018), {"'water'", "no particle", "18 mm"});
}

TEST(SampleErrors, Spacing) {
  const Scene scene = load_cup(nullptr, nullptr);
  for (const double spacing : {0.0, -0.01, std::nan(""), 1e9})
    test::expect_error(sample_scene(scene, spacing), {"spacing"});
}

TEST(SampleErrors, TooFine) {
  test::expect_error(sample_scene(load_cup(nullptr, nullptr), 0.0002),
                     {"cup.gltf", "spacing", "0.2 mm", "fluid particles"});
}

TEST(SampleErrors, OfASceneThatIsInNoFileNameNone) {
  Scene scene = load_cup(nullptr, nullptr);
  scene.source_file.clear();
  const std::string spacing = sample_scene(scene, 0.0002).error().text();
  EXPECT_TRUE(spacing.starts_with("spacing: is 0.2 mm")) << spacing;
  const std::string wall = sample_scene(scene, 0.05).error().text();
  EXPECT_TRUE(wall.starts_with("node 'cup': its walls")) << wall;
}

TEST(Sampling, TellsHowFarItIsAndHowLongItTakes) {
  const Scene scene = load_cup(nullptr, nullptr);
  std::vector<double> told;
  const auto sampled = sample_scene(scene, 0.008, nullptr, [&](double share) { told.push_back(share); });
  ASSERT_TRUE(sampled) << sampled.error().text();
  ASSERT_GE(told.size(), 3u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.front(), 0.0);
  EXPECT_LE(told.back(), 1.0);
  EXPECT_GT(told.back(), 0.5) << "bodies are most of the work";
  const auto seconds = [&](double spacing) { return estimate_sampling(estimate_particles(scene, spacing)); };
  EXPECT_GT(seconds(0.002), 4.0 * seconds(0.004));
}

TEST(SampleErrors, ThinnestWallWithoutWallsIsInfinite) {
  EXPECT_TRUE(std::isinf(thinnest_wall(Scene{})));
}

}  // namespace
}  // namespace slosh
