// Bodies that were cut, as they are drawn.
#include <gtest/gtest.h>

#include <algorithm>

#include "peer/view/body_walls.h"
#include "peer/view/cut_mesh.h"
#include "peer/view/frame_builder.h"
#include "scenes/make/solid.h"
#include "scenes/mesh/closed.h"

namespace slosh {
namespace {

TriangleMesh block() {
  TriangleMesh mesh = make::with_normals(make::box(glm::dvec3(-0.1), glm::dvec3(0.1)));
  for (const glm::vec3& p : mesh.positions) mesh.texcoords.emplace_back(p.x, p.y);
  return mesh;
}

double volume_of(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const glm::uvec3& t : mesh.triangles)
    volume += glm::dot(glm::dvec3(mesh.positions[t.x]),
                       glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
              6.0;
  return volume;
}

TEST(CutMesh, WhatIsLeftIsClosedAndItsPartsAddUp) {
  const TriangleMesh whole = block();
  const CutPlane aslant{glm::normalize(glm::dvec3(1.0, 2.0, -0.5)), 0.02}, upright{{1.0, 0.0, 0.0}, -0.03};
  const std::vector<std::vector<CutPlane>> parts{{aslant, upright},
                                                 {aslant, upright.reversed()},
                                                 {aslant.reversed(), upright},
                                                 {aslant.reversed(), upright.reversed()}};
  double sum = 0.0;
  for (const std::vector<CutPlane>& planes : parts) {
    const TriangleMesh part = cut_mesh(whole, planes);
    EXPECT_FALSE(mesh::find_defects(mesh::weld(part)).any());
    ASSERT_EQ(part.normals.size(), part.positions.size());
    ASSERT_EQ(part.texcoords.size(), part.positions.size());
    for (const glm::vec3& p : part.positions)
      for (const CutPlane& plane : planes) EXPECT_LT(plane.distance(glm::dvec3(p)), 1e-7);
    for (const glm::uvec3& t : part.triangles) {
      const glm::vec3 a = part.positions[t.x];
      const glm::vec3 area = glm::cross(part.positions[t.y] - a, part.positions[t.z] - a);
      if (glm::length(area) > 1e-7f) EXPECT_GT(glm::dot(glm::normalize(area), part.normals[t.x]), 0.99f);
    }
    sum += volume_of(part);
  }
  EXPECT_NEAR(sum, volume_of(whole), 1e-7 * sum);
  EXPECT_NEAR(volume_of(cut_mesh(whole, {{upright}})), 0.07 * 0.2 * 0.2, 1e-8);
  EXPECT_TRUE(cut_mesh(whole, {{{{1.0, 0.0, 0.0}, -0.2}}}).triangles.empty());
}

TEST(CutMesh, WhatAStrangerCallsABodyIsDrawnSomehow) {
  TriangleMesh odd = block();
  odd.triangles.emplace_back(0, 1, 4'000'000);
  odd.triangles.resize(8);  // open
  odd.normals.resize(2);
  odd.texcoords.resize(3);
  const std::vector<CutPlane> planes(kMaxCutPlanes, {{0.0, 1.0, 0.0}, 0.0});
  const TriangleMesh cut = cut_mesh(odd, planes);
  EXPECT_EQ(cut.positions.size(), 3 * cut.triangles.size());
}

const Pose kAwayPose{glm::dvec3(kAway), {1.0, 0.0, 0.0, 0.0}};

/// Counts what it has.
struct CountedMeshes final : MeshSink {
  MeshHandle add_mesh(std::span<const glm::vec3> positions, std::span<const glm::vec3>,
                      std::span<const glm::uvec3>, std::span<const glm::vec2>) override {
    sizes.push_back(positions.size());
    return static_cast<MeshHandle>(sizes.size() - 1);
  }
  void remove_mesh(MeshHandle mesh) override { sizes[mesh] = 0; }
  TextureHandle add_texture(const TextureImage&) override { return {}; }
  std::size_t kept() const { return sizes.size() - static_cast<std::size_t>(std::ranges::count(sizes, 0u)); }
  std::vector<std::size_t> sizes;
};

TEST(CutBodies, EachIsDrawnAsWhatIsLeftOfIt) {
  Scene scene;
  scene.meshes.push_back(block());
  for (int i = 0; i < 2; ++i) scene.bodies.emplace_back().mesh = 0;
  CountedMeshes meshes;
  FrameBuilder builder(scene, 0.01, meshes);
  Snapshot snapshot;
  snapshot.rigid.bodies.resize(2);
  snapshot.rigid.bodies[1].pose = kAwayPose;
  const auto shown = [&] {
    std::vector<MeshHandle> handles;
    for (const auto& each : builder.build(snapshot, 1.0).meshes) handles.push_back(each.mesh);
    return handles;
  };
  const std::size_t at_first = meshes.kept();
  const std::vector<MeshHandle> whole = shown();
  ASSERT_EQ(whole.size(), 1u);
  const auto cut = [&](double at) {
    const auto cuts = std::make_shared<BodyCuts>();
    const CutPlane plane{{1.0, 0.0, 0.0}, at};
    cuts->bodies = {{{plane}, {}}, {{plane.reversed()}, {}}};
    snapshot.rigid.bodies[1].pose = {};
    snapshot.rigid.cuts = cuts;
  };
  cut(0.0);
  const std::vector<MeshHandle> halves = shown();
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_NE(halves[0], whole[0]);
  EXPECT_NE(halves[1], halves[0]);
  EXPECT_EQ(shown(), halves) << "they are cut once";
  cut(0.05);
  EXPECT_NE(shown(), halves);
  EXPECT_EQ(meshes.kept(), at_first + 2) << "what is shown no more is given back";
  snapshot.rigid.cuts = nullptr;
  snapshot.rigid.bodies[1].pose = kAwayPose;
  EXPECT_EQ(shown(), whole) << "after a reset";
  EXPECT_EQ(meshes.kept(), at_first);
}

TEST(CutBodies, WaterLiesOnTheCutFace) {
  Scene scene;
  scene.meshes.push_back(block());
  scene.bodies.emplace_back().mesh = 0;
  BodyWalls walls(scene, 0.0f);
  BodySnapshot now;
  now.bodies.resize(1);
  walls.move(now);
  const glm::vec3 at(0.05f, 0.0f, 0.0f);
  EXPECT_FALSE(walls.nearest(at, 0.04f)) << "inside";
  const auto cuts = std::make_shared<BodyCuts>();
  cuts->bodies = {{{{{1.0, 0.0, 0.0}, 0.04}}, {}}};
  now.cuts = cuts;
  walls.move(now);
  const auto face = walls.nearest(at, 0.04f);
  ASSERT_TRUE(face);
  EXPECT_NEAR(face->at.x, 0.04f, 1e-6f);
  EXPECT_NEAR(face->normal.x, 1.0f, 1e-6f);
}

}  // namespace
}  // namespace slosh
