// Mass properties against closed forms; closedness; parts.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "scenes/make/solid.h"
#include "scenes/mesh/closed.h"
#include "scenes/mesh/tree.h"
#include "scenes/mesh/weld.h"

namespace slosh::mesh {
namespace {

struct Measured {
  Defects defects;
  Components parts;
  VolumeIntegrals volume;
};

Measured measure(const make::Solid& solid) {
  Measured out;
  const WeldedMesh welded = weld(make::with_normals(solid));
  out.defects = find_defects(welded, &out.parts);
  out.volume = integrate_volume(welded, out.parts);
  return out;
}

TEST(MassProperties, BoxOffCentre) {
  const glm::dvec3 size(0.2, 0.3, 0.5);
  const glm::dvec3 low(1.0, -2.0, 0.7);
  const Measured m = measure(make::box(low, low + size));
  ASSERT_FALSE(m.defects.any());
  const double volume = size.x * size.y * size.z;
  EXPECT_NEAR(m.volume.volume, volume, 1e-6 * volume);  // positions are floats
  EXPECT_LT(glm::distance(m.volume.centroid, low + 0.5 * size), 1e-6);
  EXPECT_NEAR(m.volume.inertia[0][0], volume / 12 * (size.y * size.y + size.z * size.z), 1e-7);
  EXPECT_NEAR(m.volume.inertia[1][1], volume / 12 * (size.x * size.x + size.z * size.z), 1e-7);
  EXPECT_NEAR(m.volume.inertia[2][2], volume / 12 * (size.x * size.x + size.y * size.y), 1e-7);
  EXPECT_NEAR(m.volume.inertia[0][1], 0.0, 1e-8);
}

TEST(MassProperties, SphereTendsToTheClosedForm) {
  const double r = 0.1;
  const Measured m = measure(make::sphere(r, 96, 192));
  ASSERT_FALSE(m.defects.any());
  const double volume = 4.0 / 3.0 * 3.14159265358979 * r * r * r;
  EXPECT_NEAR(m.volume.volume, volume, 2e-3 * volume);
  EXPECT_LT(glm::length(m.volume.centroid), 1e-6);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(m.volume.inertia[i][i], 0.4 * volume * r * r, 4e-3 * 0.4 * volume * r * r);
}

TEST(MassProperties, TurnedBoxHasTurnedInertia) {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0)));
  const Measured straight = measure(make::box({-0.1, -0.2, -0.3}, {0.1, 0.2, 0.3}));
  const Measured turned = measure(make::transformed(make::box({-0.1, -0.2, -0.3}, {0.1, 0.2, 0.3}), turn));
  const glm::dmat3 r(turn);
  const glm::dmat3 expected = r * straight.volume.inertia * glm::transpose(r);
  for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(turned.volume.inertia[c], expected[c]), 1e-7);
}

TEST(MassProperties, TwoPartsAdd) {
  const Measured m = measure(make::merged(make::box({0, 0, 0}, {1, 1, 1}), make::box({3, 0, 0}, {4, 2, 1})));
  ASSERT_FALSE(m.defects.any());
  EXPECT_EQ(m.parts.count, 2);
  EXPECT_NEAR(m.volume.volume, 3.0, 1e-6);
  EXPECT_LT(glm::distance(m.volume.centroid, (glm::dvec3(0.5) + 2.0 * glm::dvec3(3.5, 1.0, 0.5)) / 3.0),
            1e-6);
}

TEST(MassProperties, TankIsBoxMinusHollow) {
  const Measured m = measure(make::tank({0.3, 0.1, 0.2}, 0.02));
  ASSERT_FALSE(m.defects.any());
  EXPECT_EQ(m.parts.count, 1);
  EXPECT_NEAR(m.volume.volume, 0.34 * 0.12 * 0.24 - 0.3 * 0.1 * 0.2, 1e-8);
}

TEST(MassProperties, PartsThatTouchAtACornerStayApart) {
  const Measured m = measure(make::merged(make::box({0, 0, 0}, {1, 1, 1}), make::box({1, 1, 1}, {2, 2, 2})));
  EXPECT_FALSE(m.defects.any());
  EXPECT_EQ(m.parts.count, 2);
  EXPECT_NEAR(m.volume.volume, 2.0, 1e-6);
}

TEST(Defects, CountsAHolesEdges) {
  make::Solid open = make::box({0, 0, 0}, {1, 1, 1});
  open.triangles.resize(10);  // the +z side is gone
  const Measured m = measure(open);
  EXPECT_EQ(m.defects.open_edges, 4u);
  EXPECT_EQ(m.defects.crowded_edges, 0u);
  EXPECT_NEAR(m.defects.where.z, 1.0, 1e-9);
}

TEST(Defects, CountsAFlippedTrianglesEdges) {
  make::Solid flipped = make::box({0, 0, 0}, {1, 1, 1});
  std::swap(flipped.triangles[3].y, flipped.triangles[3].z);
  EXPECT_EQ(measure(flipped).defects.flipped_edges, 3u);
}

TEST(Defects, CountsAFinsEdges) {
  make::Solid fin = make::box({0, 0, 0}, {1, 1, 1});
  fin.points.emplace_back(2.0, 2.0, 2.0);
  fin.triangles.emplace_back(0, 1, 8);
  const Measured m = measure(fin);
  EXPECT_EQ(m.defects.crowded_edges, 1u);
  EXPECT_EQ(m.defects.open_edges, 2u);
}

TEST(Weld, JoinsWhatNormalsSplitAndDropsSlivers) {
  TriangleMesh split = make::with_normals(make::box({0, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(split.positions.size(), 24u);
  split.positions.push_back(split.positions[split.triangles[0].x] + glm::vec3(1e-7f, 0.0f, 0.0f));
  split.triangles.emplace_back(split.triangles[0].x, split.positions.size() - 1, split.triangles[0].z);
  const WeldedMesh welded = weld(split);
  EXPECT_EQ(welded.points.size(), 8u);
  EXPECT_EQ(welded.triangles.size(), 12u);
}

TEST(MeshTree, NearestIsThatOfBruteForce) {
  const TriangleMesh mesh =
      make::with_normals(make::merged(make::sphere(0.1, 12, 24), make::box({0.05, 0, 0}, {0.3, 0.1, 0.1})));
  const MeshTree tree(mesh);
  std::mt19937 bits(7);
  std::uniform_real_distribution<float> random(-0.4f, 0.4f);
  int hint = -1;
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 p(random(bits), random(bits), random(bits));
    float best = INFINITY;
    for (const glm::uvec3& t : mesh.triangles) {
      best = std::min(best, glm::distance(p, nearest_on_triangle(p, mesh.positions[t.x], mesh.positions[t.y],
                                                                 mesh.positions[t.z])));
    }
    const NearestPoint near = tree.nearest(p, INFINITY, hint);
    hint = near.triangle;
    ASSERT_NEAR(near.distance, best, 1e-6f);
    ASSERT_NEAR(glm::distance(near.point, p), best, 1e-6f);
  }
}

TEST(MeshTree, InsideIsTheUnion) {
  const MeshTree tree(make::with_normals(
      make::merged(make::sphere(0.1, 16, 32), make::box({0.05, -0.02, -0.02}, {0.3, 0.02, 0.02}))));
  EXPECT_TRUE(tree.inside({0.0f, 0.0f, 0.0f}));
  EXPECT_TRUE(tree.inside({0.07f, 0.0f, 0.0f}));  // in both
  EXPECT_TRUE(tree.inside({0.25f, 0.0f, 0.0f}));
  EXPECT_FALSE(tree.inside({0.25f, 0.05f, 0.0f}));
  EXPECT_FALSE(tree.inside({-0.11f, 0.0f, 0.0f}));
}

}  // namespace
}  // namespace slosh::mesh
