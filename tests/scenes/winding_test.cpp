// Winding numbers on grids whose nodes lie on faces, edges and corners.
#include "scenes/mesh/winding.h"

#include <gtest/gtest.h>

#include "scenes/make/solid.h"

namespace slosh::mesh {
namespace {

TEST(Winding, BoxCountsItsLattice) {
  const TriangleMesh box = make::with_normals(make::box({0, 0, 0}, {1, 1, 1}));
  const Grid grid{glm::dvec3(-0.25), 0.1, {16, 16, 16}};
  int inside = 0;
  for (const std::int8_t w : winding_numbers(box, grid)) {
    EXPECT_TRUE(w == 0 || w == 1);
    inside += w;
  }
  EXPECT_EQ(inside, 1000);
}

TEST(Winding, LinesThroughEdgesAndPolesLeaveNoStreak) {
  // Nodes on the axis, in the planes of edges and on the poles: everything that rays stumble over.
  const TriangleMesh ball = make::with_normals(make::sphere(0.5, 16, 32));
  const Grid grid{glm::dvec3(-1.0), 0.125, {17, 17, 17}};
  const std::vector<std::int8_t> winding = winding_numbers(ball, grid);
  for (int k = 0; k < 17; ++k) {
    for (int j = 0; j < 17; ++j) {
      for (int i = 0; i < 17; ++i) {
        const double r = glm::length(grid.origin + grid.cell * glm::dvec3(i, j, k));
        const int w = winding[i + 17 * (j + 17 * k)];
        if (r < 0.48) {
          EXPECT_EQ(w, 1) << i << " " << j << " " << k;
        }
        if (r > 0.51) {
          EXPECT_EQ(w, 0) << i << " " << j << " " << k;
        }
      }
    }
  }
}

TEST(Winding, OverlapCountsTwiceAndCavityNot) {
  make::Solid hollow = make::box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8});
  for (glm::uvec3& t : hollow.triangles) std::swap(t.y, t.z);
  const TriangleMesh shell = make::with_normals(make::merged(make::box({0, 0, 0}, {1, 1, 1}), hollow));
  const Grid one{glm::dvec3(0.1, 0.5, 0.5), 0.4, {2, 1, 1}};
  EXPECT_EQ(winding_numbers(shell, one), (std::vector<std::int8_t>{1, 0}));
  const TriangleMesh twice = make::with_normals(
      make::merged(make::box({0, 0, 0}, {1, 1, 1}), make::box({0.4, 0.1, 0.1}, {2, 0.9, 0.9})));
  EXPECT_EQ(winding_numbers(twice, one), (std::vector<std::int8_t>{1, 2}));
}

}  // namespace
}  // namespace slosh::mesh
