// Filling volumes: counts, clearance, several fluids.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scenes/mesh/closed.h"
#include "scenes/sample.h"
#include "support.h"

namespace slosh {
namespace {

using test::TempFolder;

Scene load(make::SceneWriter writer) {
  const TempFolder folder;
  EXPECT_TRUE(writer.write(folder / "scene.gltf"));
  const auto scene = load_scene(folder / "scene.gltf");
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? scene.value() : Scene{};
}

TEST(Filling, FreeBoxHoldsVolumeOverSpacingCubed) {
  make::SceneWriter writer(nlohmann::json{{"spacing_max_m", 0.01}});
  writer.add_node("water", writer.add_mesh("water", make::box({0, 0, 0}, {0.2, 0.1, 0.15}), -1),
                  {{1, 2, 3}, {1, 0, 0, 0}}, {{"slosh", "fluid"}, {"velocity_m_s", make::list({0.5, 0, 0})}});
  const Scene scene = load(std::move(writer));
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
  const auto sampled = sample_scene(load(std::move(writer)), 0.008);
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

// A vessel, or none, and one volume of water.
Scene filled(const make::Solid* vessel, const make::Solid& water, const Pose& pose = {}) {
  Scene scene;
  scene.source_file = "scene.gltf";
  scene.fluids.push_back(Fluid{});
  FluidVolume volume;
  volume.name = "water";
  volume.mesh = 0;
  volume.pose = pose;
  scene.meshes.push_back(make::with_normals(water));
  scene.fluid_volumes.push_back(volume);
  if (!vessel) return scene;
  Body body;
  body.name = "vessel";
  body.mesh = 1;
  body.pose = pose;
  scene.meshes.push_back(make::with_normals(*vessel));
  scene.bodies.push_back(body);
  return scene;
}

double volume_of(const make::Solid& solid) {
  const mesh::WeldedMesh welded = mesh::weld(make::with_normals(solid));
  mesh::Components parts;
  mesh::find_defects(welded, &parts);
  return mesh::integrate_volume(welded, parts).volume;
}

// The sampled mass is the mesh's at any spacing: in a round vessel, in a box, for a ball, for a drop's tip.
TEST(Filling, SampledMassIsTheMeshs) {
  const make::Solid glass =
      make::lathe({{0.0, -0.02}, {0.07, -0.02}, {0.07, 0.12}, {0.05, 0.12}, {0.05, 0.0}, {0.0, 0.0}}, 64);
  const make::Solid in_glass = make::lathe({{0.0, 0.0}, {0.05, 0.0}, {0.05, 0.08}, {0.0, 0.08}}, 64);
  const make::Solid tank = make::tank({0.1, 0.1, 0.1}, 0.02);
  const make::Solid in_tank = make::box({-0.05, 0.02, -0.05}, {0.05, 0.09, 0.05});
  const make::Solid cone = make::lathe({{0.0, 0.0}, {0.05, 0.0}, {0.0, 0.12}}, 64);
  const make::Solid ball = make::sphere(0.05, 48, 96);
  struct Case {
    const char* name;
    const make::Solid* vessel;
    const make::Solid* water;
  };
  for (const Case& c :
       {Case{"glass", &glass, &in_glass}, Case{"tank", &tank, &in_tank}, Case{"free box", nullptr, &in_tank},
        Case{"cone", nullptr, &cone}, Case{"ball", nullptr, &ball}}) {
    const double wanted = volume_of(*c.water);
    const Scene scene = filled(c.vessel, *c.water);
    double worst = 0.0;
    for (double spacing = 0.005; spacing < 0.0101; spacing += 0.0012) {
      const auto sampled = sample_scene(scene, spacing);
      ASSERT_TRUE(sampled) << sampled.error().text();
      const double volume =
          static_cast<double>(sampled.value().fluid_positions.size()) * std::pow(spacing, 3);
      worst = std::max(worst, std::abs(volume / wanted - 1.0));
    }
    std::printf("  %s: sampled mass off by up to %.2f %%\n", c.name, 100.0 * worst);
    EXPECT_LT(worst, 0.005) << c.name;
  }
}

// What walls keep out goes on top, and top is where gravity says: the same glass lying in its file.
TEST(Filling, WhatIsMissingGoesUp) {
  const make::Solid glass =
      make::lathe({{0.0, -0.02}, {0.07, -0.02}, {0.07, 0.12}, {0.05, 0.12}, {0.05, 0.0}, {0.0, 0.0}}, 64);
  const make::Solid in_glass = make::lathe({{0.0, 0.0}, {0.05, 0.0}, {0.05, 0.08}, {0.0, 0.08}}, 64);
  glm::dmat4 laid(1.0);  // the mesh's z is up
  laid[1] = {0.0, 0.0, 1.0, 0.0};
  laid[2] = {0.0, -1.0, 0.0, 0.0};
  const make::Solid lying_glass = make::transformed(glass, laid), lying = make::transformed(in_glass, laid);
  const Pose raised{{0.0, 0.0, 0.0}, glm::angleAxis(-0.5 * 3.14159265358979323846, glm::dvec3(1, 0, 0))};
  const auto upright = sample_scene(filled(&glass, in_glass), 0.008);
  const auto stood_up = sample_scene(filled(&lying_glass, lying, raised), 0.008);
  ASSERT_TRUE(upright && stood_up);
  const auto top = [](const SampledScene& sampled) {
    float highest = 0.0f;
    for (const glm::vec3& p : sampled.fluid_positions) highest = std::max(highest, p.y);
    return highest;
  };
  EXPECT_EQ(stood_up.value().fluid_positions.size(), upright.value().fluid_positions.size());
  EXPECT_NEAR(top(stood_up.value()), top(upright.value()), 1e-4);
  EXPECT_GT(top(upright.value()), 0.08f) << "nothing was missing: the test tests nothing";
}

// A partition that is part of the tank's mesh, across the water, let into the walls or flush with them, thick
// or as thin as the spacing: no particle starts inside it, and the water is what is left of its mesh.
TEST(Filling, StaysOutOfAMergedPartition) {
  const make::Solid water = make::box({-0.2, 0.02, -0.05}, {0.2, 0.08, 0.05});
  for (const double half : {0.008, 0.005}) {
    for (const double overlap : {0.02, 0.0}) {
      const make::Solid partition =
          make::box({-half, 0.02 - overlap, -0.05 - overlap}, {half, 0.09, 0.05 + overlap});
      const make::Solid tank = make::merged(make::tank({0.4, 0.1, 0.1}, 0.02), partition);
      for (const double spacing : {0.005, 0.008, 0.01}) {
        const auto sampled = sample_scene(filled(&tank, water), spacing);
        ASSERT_TRUE(sampled) << sampled.error().text();
        const auto near = static_cast<float>(half + 0.4 * spacing);
        const std::size_t inside = static_cast<std::size_t>(
            std::count_if(sampled.value().fluid_positions.begin(), sampled.value().fluid_positions.end(),
                          [&](const glm::vec3& p) { return std::abs(p.x) < near && p.y < 0.09f; }));
        const double wanted = (0.4 - 2.0 * half) * 0.06 * 0.1;
        const double have =
            static_cast<double>(sampled.value().fluid_positions.size()) * std::pow(spacing, 3);
        std::printf("  partition of %.0f mm overlapping by %.0f at %.0f mm: volume off by %+.2f %%\n",
                    2e3 * half, 1e3 * overlap, 1e3 * spacing, 100.0 * (have / wanted - 1.0));
        EXPECT_EQ(inside, 0u) << half << " overlapping by " << overlap << " at " << spacing;
        EXPECT_LT(std::abs(have / wanted - 1.0), 0.005)
            << half << " overlapping by " << overlap << " at " << spacing;
      }
    }
  }
}

TEST(Filling, RepeatsToTheBit) {
  const Scene scene = load(test::make_cup());
  EXPECT_EQ(sample_scene(scene, 0.011).value().fluid_positions,
            sample_scene(scene, 0.011).value().fluid_positions);
}

}  // namespace
}  // namespace slosh
