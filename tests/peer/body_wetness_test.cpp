// What fluid touches is wet, and dry in the time that is stated.
#include "peer/view/body_wetness.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <limits>

#include "scenes/make/solid.h"

namespace slosh {
namespace {

constexpr float kFine = 0.01f;

/// Boards of 0.4 × 0.2 m, `thick` m, their tops at y = 0.
Scene boards(int count, float thick = 0.02f) {
  Scene scene;
  TriangleMesh board;
  const glm::vec3 low(-0.2f, -thick, -0.1f), high(0.2f, 0.0f, 0.1f);
  for (int corner = 0; corner < 8; ++corner)
    board.positions.emplace_back(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                 corner & 4 ? high.z : low.z);
  for (const glm::uvec4& side : {glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 1, 5, 4), glm::uvec4(0, 2, 3, 1),
                                 glm::uvec4(4, 5, 7, 6), glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5)}) {
    board.triangles.emplace_back(side.x, side.y, side.z);
    board.triangles.emplace_back(side.x, side.z, side.w);
  }
  for (int i = 0; i < count; ++i) {
    scene.meshes.push_back(board);
    scene.bodies.emplace_back().mesh = i;
  }
  return scene;
}

Snapshot seen_at(double time, std::vector<glm::vec3> points, std::size_t bodies = 1) {
  Snapshot out;
  out.rigid.time = time;
  out.rigid.bodies.resize(bodies);
  out.fluid_index.assign(points.size(), 0);
  out.positions = std::move(points);
  return out;
}

/// The share that a face's point is drawn with.
int share_at(const Wetness& wet, const glm::vec3& face, const glm::vec3& normal) {
  if (wet.version == 0) return 0;
  const glm::ivec3 cell((face + wet.off * normal - wet.low) / wet.cell);
  return wet.shares[static_cast<std::size_t>(cell.x + wet.size.x * (cell.y + wet.size.y * cell.z))];
}

constexpr int kIsDry = 64;
constexpr int kIsWet = 192;
const glm::vec3 kUp(0.0f, 1.0f, 0.0f);

TEST(BodyWetness, WhatADropLiesOnIsWetAndDriesInTime) {
  const Scene scene = boards(1);
  BodyWetness wetness(scene, kFine);
  EXPECT_EQ(wetness.of(0).version, 0u);
  const glm::vec3 spot(0.05f, 0.0f, 0.02f);
  wetness.record(seen_at(0.0, {spot + 0.5f * kFine * kUp}));
  const std::uint64_t first = wetness.of(0).version;
  EXPECT_GE(share_at(wetness.of(0), spot, kUp), kIsWet);
  EXPECT_LT(share_at(wetness.of(0), spot + glm::vec3(2.0f * kFine, 0.0f, 0.0f), kUp), kIsDry);
  EXPECT_LT(share_at(wetness.of(0), spot - glm::vec3(0.0f, 0.02f, 0.0f), -kUp), kIsDry)
      << "not through the board";
  wetness.record(seen_at(0.5 * kDriesIn, {}));
  const int half = share_at(wetness.of(0), spot, kUp);
  EXPECT_GT(half, kIsDry);
  EXPECT_LT(half, kIsWet);
  EXPECT_NE(wetness.of(0).version, first);
  wetness.record(seen_at(kDriesIn, {}));
  EXPECT_LT(share_at(wetness.of(0), spot, kUp), kIsDry);
  wetness.record(seen_at(2.0 * kDriesIn, {}));
  EXPECT_EQ(wetness.of(0).version, 0u) << "nothing is left";
}

TEST(BodyWetness, WhatOnlyPassesByWetsNothing) {
  const Scene scene = boards(1);
  BodyWetness wetness(scene, kFine);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Snapshot passing =
      seen_at(0.0, {{0.0f, 1.6f * kFine, 0.0f}, {0.0f, 5.0f, 0.0f}, {nan, nan, nan}, {0.0f, 0.005f, 0.0f}});
  passing.fluid_index[3] = 255;  // it is not there
  wetness.record(passing);
  EXPECT_EQ(wetness.of(0).version, 0u);
  EXPECT_EQ(wetness.of(7).version, 0u) << "no such body";
}

TEST(BodyWetness, ABodyTakesItsWetSideAlong) {
  const Scene scene = boards(2);
  BodyWetness wetness(scene, kFine);
  // The second stands upright, its top to −x, at x = 1 m.
  Snapshot dipped = seen_at(0.0, {{1.0f - 0.5f * kFine, 0.05f, 0.02f}}, 2);
  Pose& pose = dipped.rigid.bodies[1].pose;
  pose.position = {1.0, 0.0, 0.0};
  pose.orientation = glm::angleAxis(glm::half_pi<double>(), glm::dvec3(0.0, 0.0, 1.0));
  wetness.record(dipped);
  EXPECT_EQ(wetness.of(0).version, 0u);
  EXPECT_GE(share_at(wetness.of(1), {0.05f, 0.0f, 0.02f}, kUp), kIsWet);
  wetness.record(seen_at(0.1, {}, 2));
  EXPECT_GE(share_at(wetness.of(1), {0.05f, 0.0f, 0.02f}, kUp), kIsWet) << "wherever it goes";
}

TEST(BodyWetness, ARunThatBeginsAgainBeginsDry) {
  const Scene scene = boards(1);
  BodyWetness wetness(scene, kFine);
  wetness.record(seen_at(3.0, {{0.0f, 0.005f, 0.0f}}));
  ASSERT_GE(share_at(wetness.of(0), glm::vec3(0.0f), kUp), kIsWet);
  const std::uint64_t before = wetness.of(0).version;
  wetness.record(seen_at(0.0, {}));
  EXPECT_EQ(wetness.of(0).version, 0u);
  wetness.record(seen_at(0.1, {{0.1f, 0.005f, 0.0f}}));
  EXPECT_GT(wetness.of(0).version, before) << "what was drawn before is not taken for this";
}

TEST(BodyWetness, OfVeryManyParticlesEachHasItsTurn) {
  const Scene scene = boards(1);
  BodyWetness wetness(scene, kFine);
  std::vector<glm::vec3> points(100000, glm::vec3(0.0f, 3.0f, 0.0f));
  for (int i = 0; i < 8; ++i)
    points[static_cast<std::size_t>(12345 * i + i)] = {0.04f * static_cast<float>(i) - 0.16f, 0.005f, 0.0f};
  for (int picture = 0; picture < 5; ++picture) wetness.record(seen_at(0.02 * picture, points));
  for (int i = 0; i < 8; ++i)
    EXPECT_GE(share_at(wetness.of(0), {0.04f * static_cast<float>(i) - 0.16f, 0.0f, 0.0f}, kUp), kIsWet) << i;
}

TEST(BodyWetness, OfVeryManyBodiesNoneHasManyCells) {
  Scene scene = boards(1000);
  for (TriangleMesh& mesh : scene.meshes)
    for (glm::vec3& at : mesh.positions) at *= 20.0f;
  BodyWetness wetness(scene, kFine);
  for (int picture = 0; picture < 3; ++picture)
    wetness.record(seen_at(0.02 * picture, {{0.0f, 0.005f, 0.0f}}, 1000));
  std::size_t cells = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    EXPECT_GE(share_at(wetness.of(i), glm::vec3(0.0f), kUp), kIsWet) << i;
    cells += wetness.of(i).shares.size();
  }
  EXPECT_LE(cells, std::size_t{1} << 22);
}

TEST(BodyWetness, VeryManyLargeTrianglesTakeNoLonger) {
  Scene scene = boards(1);
  TriangleMesh& mesh = scene.meshes[0];
  for (int i = 0; i < 100000; ++i) mesh.triangles.push_back(mesh.triangles[static_cast<std::size_t>(i) % 12]);
  BodyWetness wetness(scene, kFine);
  wetness.record(seen_at(0.0, {{0.0f, 0.005f, 0.0f}}));
  EXPECT_GE(share_at(wetness.of(0), glm::vec3(0.0f), kUp), kIsWet);
}

TEST(BodyWetness, ALargeBodyHasLargerCellsAndNoMore) {
  Scene scene = boards(1);
  for (glm::vec3& at : scene.meshes[0].positions) at *= 20.0f;
  BodyWetness wetness(scene, kFine);
  wetness.record(seen_at(0.0, {{0.0f, 0.005f, 0.0f}}));
  const Wetness wet = wetness.of(0);
  EXPECT_LE(wet.shares.size(), std::size_t{1} << 19);
  EXPECT_GT(wet.cell, kFine);
  EXPECT_GE(share_at(wet, glm::vec3(0.0f), kUp), kIsWet);
}

}  // namespace
}  // namespace slosh
