// Filling volumes: counts, clearance, several fluids.
#include <cmath>

#include "scenes/sample.h"
#include "support.h"

namespace slosh {
namespace {

using test::TempFolder;

Scene load(const make::SceneWriter& writer) {
  const TempFolder folder;
  make::SceneWriter copy = writer;
  EXPECT_TRUE(copy.write(folder / "scene.gltf"));
  const auto scene = load_scene(folder / "scene.gltf");
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? scene.value() : Scene{};
}

TEST(Filling, FreeBoxHoldsVolumeOverSpacingCubed) {
  make::SceneWriter writer(nlohmann::json{{"spacing_max_m", 0.01}});
  writer.add_node("water", writer.add_mesh("water", make::box({0, 0, 0}, {0.2, 0.1, 0.15}), -1),
                  {{1, 2, 3}, {1, 0, 0, 0}}, {{"slosh", "fluid"}, {"velocity_m_s", make::list({0.5, 0, 0})}});
  const Scene scene = load(writer);
  const auto sampled = sample_scene(scene, 0.01);
  ASSERT_TRUE(sampled) << sampled.error().text();
  EXPECT_EQ(sampled.value().fluid_positions.size(), 20u * 10u * 15u);
  EXPECT_NEAR(estimate_particles(scene, 0.01).fluid, 3000.0, 1.0);
  EXPECT_EQ(sampled.value().fluid_velocities.at(7), glm::vec3(0.5f, 0.0f, 0.0f));
  EXPECT_EQ(sampled.value().fluid_velocities.size(), 3000u);
  EXPECT_EQ(sampled.value().fluid_index.size(), 3000u);
  glm::vec3 low(1e9f);
  for (const glm::vec3& p : sampled.value().fluid_positions) low = glm::min(low, p);
  EXPECT_LT(glm::distance(low, glm::vec3(1.005f, 2.005f, 3.005f)), 1e-5f);
}

TEST(Filling, BallHoldsItsVolume) {
  make::SceneWriter writer(nlohmann::json::object());
  writer.add_node("water", writer.add_mesh("water", make::sphere(0.1, 48, 96), -1), {}, {{"slosh", "fluid"}});
  const auto sampled = sample_scene(load(writer), 0.008);
  ASSERT_TRUE(sampled) << sampled.error().text();
  const double wanted = 4.0 / 3.0 * 3.14159265 * 1e-3 / (0.008 * 0.008 * 0.008);
  EXPECT_NEAR(static_cast<double>(sampled.value().fluid_positions.size()), wanted, 0.02 * wanted);
}

TEST(Filling, KeepsHalfASpacingClearOfWalls) {
  const Scene scene = load(test::make_cup());
  const auto sampled = sample_scene(scene, 0.01);
  ASSERT_TRUE(sampled) << sampled.error().text();
  EXPECT_EQ(sampled.value().fluid_positions.size(), 10u * 7u * 10u);
  for (const glm::vec3& p : sampled.value().fluid_positions) {
    EXPECT_LE(std::max(std::abs(p.x), std::abs(p.z)), 0.0451f);
    EXPECT_GE(p.y, 0.0249f);
  }
}

TEST(Filling, OilOnWaterKeepsBothAndTheirIndices) {
  make::SceneWriter writer(nlohmann::json{
      {"fluids", {{"oil", {{"density_kg_m3", 900.0}}}, {"water", {{"density_kg_m3", 1000.0}}}}}});
  const int a = writer.add_mesh("a", make::box({0, 0, 0}, {0.1, 0.05, 0.1}), -1);
  writer.add_node("below", a, {}, {{"slosh", "fluid"}, {"fluid", "water"}});
  writer.add_node("above", a, {{0, 0.05, 0}, {1, 0, 0, 0}}, {{"slosh", "fluid"}, {"fluid", "oil"}});
  // The same place again: nothing of it may come in twice.
  writer.add_node("again", a, {}, {{"slosh", "fluid"}, {"fluid", "oil"}});
  const TempFolder folder;
  ASSERT_TRUE(writer.write(folder / "scene.gltf"));
  const auto scene = load_scene(folder / "scene.gltf");
  ASSERT_TRUE(scene) << scene.error().text();
  const auto sampled = sample_scene(scene.value(), 0.01);
  ASSERT_FALSE(sampled);  // "again" is left without a particle
  EXPECT_NE(sampled.error().text().find("'again'"), std::string::npos);
  Scene two = scene.value();
  two.fluid_volumes.pop_back();
  const auto both = sample_scene(two, 0.01);
  ASSERT_TRUE(both) << both.error().text();
  ASSERT_EQ(both.value().fluid_index.size(), 1000u);
  EXPECT_EQ(two.fluids[both.value().fluid_index.front()].name, "water");
  EXPECT_EQ(two.fluids[both.value().fluid_index.back()].name, "oil");
}

TEST(Filling, RepeatsToTheBit) {
  const Scene scene = load(test::make_cup());
  EXPECT_EQ(sample_scene(scene, 0.011).value().fluid_positions,
            sample_scene(scene, 0.011).value().fluid_positions);
}

}  // namespace
}  // namespace slosh
