// Distance fields against analytic ones.
#include "scenes/sampling/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scenes/make/solid.h"
#include "scenes/mesh/closed.h"

namespace slosh {
namespace {

double box_distance(const glm::dvec3& p, const glm::dvec3& half) {
  const glm::dvec3 q = glm::abs(p) - half;
  return glm::length(glm::max(q, glm::dvec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

DistanceField field_of(const make::Solid& solid, double spacing) {
  const TriangleMesh mesh = make::with_normals(solid);
  return sampling::make_distance_field(mesh, mesh::MeshTree(mesh), spacing);
}

TEST(DistanceFields, BoxNodesAreExact) {
  const glm::dvec3 half(0.10, 0.06, 0.03);
  const DistanceField field = field_of(make::box(-half, half), 0.01);
  EXPECT_LE(field.cell, 0.0051f);
  std::size_t index = 0;
  for (int k = 0; k < field.size.z; ++k) {
    for (int j = 0; j < field.size.y; ++j) {
      for (int i = 0; i < field.size.x; ++i, ++index) {
        const glm::dvec3 p = glm::dvec3(field.origin) + static_cast<double>(field.cell) * glm::dvec3(i, j, k);
        ASSERT_NEAR(field.distance[index], box_distance(p, half), 2e-6) << i << " " << j << " " << k;
      }
    }
  }
}

TEST(DistanceFields, SphereEverywhere) {
  const DistanceField field = field_of(make::sphere(0.1, 64, 128), 0.012);
  std::mt19937 bits(5);
  std::uniform_real_distribution<float> random(-0.12f, 0.12f);
  for (int n = 0; n < 2000; ++n) {
    const glm::vec3 p(random(bits), random(bits), random(bits));
    if (glm::length(p) < 0.02f) continue;  // the centre, where the distance has a kink
    const DistanceSample sample = sample_distance(field.view(), p);
    EXPECT_NEAR(sample.distance, glm::length(p) - 0.1f, 1.0e-3f);
    EXPECT_GT(glm::dot(glm::normalize(sample.gradient), glm::normalize(p)), 0.97f);
  }
}

TEST(DistanceFields, ReachesThreeSpacingsAndHasAtMost96Nodes) {
  const DistanceField field = field_of(make::box({-0.5, -0.02, -0.3}, {0.5, 0.02, 0.3}), 0.008);
  for (int a = 0; a < 3; ++a) EXPECT_LE(field.size[a], sampling::kMaxNodes);
  const glm::vec3 high = field.origin + field.cell * glm::vec3(field.size - 1);
  EXPECT_GE(high.x, 0.5f + 0.0239f);
  EXPECT_LE(field.origin.y, -0.02f - 0.0239f);
  // The cell (11 mm) is finer than the slab (40 mm): its middle is inside.
  EXPECT_NEAR(sample_distance(field.view(), {0.1f, 0.0f, 0.1f}).distance, -0.02f, 0.005f);
}

TEST(DistanceFields, WallsThinnerThanACellKeepTheirSigns) {
  // A sheet of 2 mm under cells of 15 mm: nodes may miss it, but none outside may turn negative.
  const glm::dvec3 half(0.7, 0.001, 0.7);
  const DistanceField field = field_of(make::box(-half, half), 0.02);
  ASSERT_GT(field.cell, 0.01f);
  std::size_t index = 0;
  for (int k = 0; k < field.size.z; ++k) {
    for (int j = 0; j < field.size.y; ++j) {
      for (int i = 0; i < field.size.x; ++i, ++index) {
        const glm::dvec3 p = glm::dvec3(field.origin) + static_cast<double>(field.cell) * glm::dvec3(i, j, k);
        const double exact = box_distance(p, half);
        if (std::abs(exact) > 1e-6) {
          ASSERT_EQ(field.distance[index] < 0.0f, exact < 0.0);
        }
      }
    }
  }
}

TEST(DistanceFields, TwoPartsAreOneSolid) {
  const DistanceField field = field_of(make::merged(make::box({-0.1, -0.02, -0.02}, {0.02, 0.02, 0.02}),
                                                    make::box({-0.02, -0.02, -0.02}, {0.1, 0.02, 0.02})),
                                       0.01);
  for (float x = -0.09f; x < 0.09f; x += 0.01f)
    EXPECT_LT(sample_distance(field.view(), {x, 0.0f, 0.0f}).distance, 0.0f) << x;
  EXPECT_NEAR(sample_distance(field.view(), {0.0f, 0.04f, 0.0f}).distance, 0.02f, 1e-3f);
}

}  // namespace
}  // namespace slosh
