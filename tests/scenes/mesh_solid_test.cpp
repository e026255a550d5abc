// The solid inside a mesh, asked by the mesh itself, against analytic ones.
#include "scenes/mesh/mesh_solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scenes/make/solid.h"
#include "scenes/mesh/closed.h"

namespace slosh {
namespace {

using make::Solid;

mesh::MeshSolid solid_of(const Solid& solid) {
  const TriangleMesh triangles = make::with_normals(solid);
  mesh::Components parts;
  const mesh::WeldedMesh welded = mesh::weld(triangles);
  mesh::find_defects(welded, &parts);
  return {welded, mesh::MeshTree(triangles), parts};
}

double box_distance(const glm::dvec3& p, const glm::dvec3& half) {
  const glm::dvec3 q = glm::abs(p) - half;
  return glm::length(glm::max(q, glm::dvec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

TEST(MeshSolid, ABoxIsExactAtItsEdgesToo) {
  const glm::dvec3 half(0.10, 0.06, 0.03);
  const mesh::MeshSolid box = solid_of(make::box(-half, half));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.12, 0.12);
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 p(place(random), place(random), place(random));
    const DistanceSample s = box.at(glm::vec3(p));
    ASSERT_NEAR(s.distance, box_distance(p, half), 1e-7) << p.x << " " << p.y << " " << p.z;
    ASSERT_NEAR(glm::length(s.gradient), 1.0f, 1e-3f);
    // A step along the gradient comes as much nearer or farther, but across the middle of the box.
    if (s.distance < -0.028f) continue;
    const float step = 1e-3f;
    if (std::abs(s.distance) > step)
      ASSERT_NEAR(box.at(glm::vec3(p) + step * s.gradient).distance, s.distance + step, 2e-6);
  }
}

// On the surface the way to it is rounding, and says nothing of where it faces: along edges samples of a
// sheet were led astray by that, and stood proud.
TEST(MeshSolid, OnItsSurfaceTheGradientIsAFacesNormal) {
  const mesh::MeshSolid box = solid_of(make::box(glm::dvec3(-0.04), glm::dvec3(0.04)));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> along(-0.04f, 0.04f), off(-1e-7f, 1e-7f);
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 p(0.04f + off(random), along(random), 0.02f + 0.5f * along(random));
    const DistanceSample s = box.at(p);
    ASSERT_LT(std::abs(s.distance), 3e-7f);
    ASSERT_EQ(s.gradient, glm::vec3(1.0f, 0.0f, 0.0f)) << p.y << " " << p.z;
  }
}

TEST(MeshSolid, WherePartsOverlapThereIsNoSurface) {
  const glm::dvec3 half(0.04, 0.04, 0.04), aside(0.05, 0.0, 0.0);
  const Solid two = make::merged(make::box(-half, half), make::box(aside - half, aside + half));
  const mesh::MeshSolid solid = solid_of(two);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.06, 0.11);
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 p(place(random), place(random), place(random));
    const double distance = std::min(box_distance(p, half), box_distance(p - aside, half));
    ASSERT_NEAR(solid.at(glm::vec3(p)).distance, distance, 1e-7) << p.x << " " << p.y << " " << p.z;
  }
}

// A part that faces inward.
TEST(MeshSolid, ACavityIsOutside) {
  Solid hollow = make::box(glm::dvec3(-0.04), glm::dvec3(0.04)),
        cavity = make::box(glm::dvec3(-0.02), glm::dvec3(0.02));
  for (glm::uvec3& t : cavity.triangles) std::swap(t.y, t.z);
  const mesh::MeshSolid solid = solid_of(make::merged(std::move(hollow), cavity));
  EXPECT_NEAR(solid.at({0.0f, 0.0f, 0.001f}).distance, 0.019f, 1e-7f);
  EXPECT_NEAR(solid.at({0.025f, 0.003f, 0.001f}).distance, -0.005f, 1e-7f);
  EXPECT_NEAR(solid.at({0.05f, 0.0f, 0.0f}).distance, 0.01f, 1e-7f);
}

TEST(MeshSolid, AWallIsAsThickAsItIs) {
  const mesh::MeshSolid plate = solid_of(make::box({-0.05, -0.007, -0.04}, {0.05, 0.007, 0.04}));
  EXPECT_NEAR(plate.thickness({0.013f, 0.007f, 0.011f}, {0.0f, -1.0f, 0.0f}), 0.014f, 1e-6f);
  EXPECT_NEAR(plate.thickness({0.05f, 0.001f, 0.011f}, {-1.0f, 0.0f, 0.0f}), 0.1f, 1e-6f);
  // Just within an edge.
  EXPECT_NEAR(plate.thickness({0.0499999f, 0.007f, 0.011f}, {0.0f, -1.0f, 0.0f}), 0.014f, 1e-6f);
  const mesh::MeshSolid ball = solid_of(make::sphere(0.03, 24, 48));
  EXPECT_NEAR(ball.thickness({0.0f, 0.03f, 0.0f}, {0.0f, -1.0f, 0.0f}), 0.06f, 1e-5f);
  // Slanting: out through the side of the ball.
  const glm::vec3 top(0.0f, 0.03f, 0.0f);
  EXPECT_TRUE(std::isinf(ball.thickness(top, glm::normalize(glm::vec3(1.0f, -0.3f, 0.0f)))));
}

}  // namespace
}  // namespace slosh
