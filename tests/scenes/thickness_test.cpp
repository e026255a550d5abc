// How thick walls are said to be.
#include "scenes/sampling/thickness.h"

#include <gtest/gtest.h>

#include "scenes/make/solid.h"

namespace slosh {
namespace {

double thickness(const make::Solid& solid) {
  const TriangleMesh mesh = make::with_normals(solid);
  return sampling::wall_thickness(mesh, mesh::MeshTree(mesh));
}

TEST(Thickness, BoxIsItsShortestSide) {
  EXPECT_NEAR(thickness(make::box({0, 0, 0}, {0.5, 0.04, 0.3})), 0.04, 1e-6);
}
TEST(Thickness, TankIsItsWall) {
  EXPECT_NEAR(thickness(make::tank({0.3, 0.1, 0.2}, 0.014)), 0.014, 1e-6);
}
TEST(Thickness, BallIsItsDiameter) {
  EXPECT_NEAR(thickness(make::sphere(0.1, 32, 64)), 0.2, 0.004);
}
TEST(Thickness, RodIsItsDiameter) {
  EXPECT_NEAR(thickness(make::capsule(0.01, 0.0, 0.3, 8, 32)), 0.02, 4e-4);
}

TEST(Thickness, SharpEdgeIsNotAWall) {
  // A roof with an edge of 60° along its whole length, 0.1 wide at the foot.
  make::Solid roof;
  roof.points = {{-0.05, 0, 0},   {0.05, 0, 0},   {0, 0.0866, 0},
                 {-0.05, 0, 0.4}, {0.05, 0, 0.4}, {0, 0.0866, 0.4}};
  roof.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  EXPECT_GT(thickness(roof), 0.02);
}

}  // namespace
}  // namespace slosh
