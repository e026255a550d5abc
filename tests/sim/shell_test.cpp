// Which particles are seen from outside, against bodies of fluid whose inside is known.
#include "sim/shell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace slosh {
namespace {

constexpr double kSpacing = 0.01;

/// A cube of n³ particles on a lattice.
std::vector<glm::vec3> cube(int n) {
  std::vector<glm::vec3> points;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) points.emplace_back(kSpacing * glm::dvec3(x, y, z));
    }
  }
  return points;
}

TEST(Shell, a_cubes_faces_are_shell_and_its_core_is_not) {
  constexpr int kN = 20;
  const std::vector<glm::vec3> points = cube(kN);
  const std::vector<std::uint8_t> fluid(points.size(), 0);
  std::vector<std::uint8_t> shell;
  find_shell(points, fluid, kSpacing, shell);
  ASSERT_EQ(shell.size(), points.size());
  std::size_t marked = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::vec3 p = points[i] / static_cast<float>(kSpacing);
    const float depth = std::min({p.x, p.y, p.z, kN - 1 - p.x, kN - 1 - p.y, kN - 1 - p.z});
    const bool outermost = depth<0.5f, deep = depth> 3.5f;
    EXPECT_TRUE(!outermost || shell[i] == 1) << i;
    EXPECT_TRUE(!deep || shell[i] == 0) << i;
    marked += shell[i];
  }
  EXPECT_LT(marked, points.size() / 2);
}

TEST(Shell, drops_far_apart_are_all_shell) {
  std::vector<glm::vec3> points;
  for (int i = 0; i < 50; ++i) points.emplace_back(0.1f * static_cast<float>(i), 0.0f, 0.0f);
  std::vector<std::uint8_t> shell;
  find_shell(points, std::vector<std::uint8_t>(50, 0), kSpacing, shell);
  EXPECT_EQ(std::count(shell.begin(), shell.end(), 1), 50);
}

TEST(Shell, retired_and_broken_particles_are_none_and_do_not_fill_a_hole) {
  std::vector<glm::vec3> points = cube(9);
  std::vector<std::uint8_t> fluid(points.size(), 0);
  points.push_back(glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  points.push_back(glm::vec3(0.04f));
  fluid.push_back(0);
  fluid.push_back(255);
  std::vector<std::uint8_t> shell;
  find_shell(points, fluid, kSpacing, shell);
  EXPECT_EQ(shell[points.size() - 1], 0);
  EXPECT_EQ(shell[points.size() - 2], 0);
}

TEST(Shell, an_empty_and_a_boundless_fluid_are_no_trouble) {
  std::vector<std::uint8_t> shell{1, 1};
  find_shell({}, {}, kSpacing, shell);
  EXPECT_TRUE(shell.empty());
  const std::vector<glm::vec3> points{glm::vec3(-1e30f), glm::vec3(1e30f)};
  find_shell(points, std::vector<std::uint8_t>(2, 0), kSpacing, shell);
  EXPECT_EQ(shell, (std::vector<std::uint8_t>{1, 1}));
}

}  // namespace
}  // namespace slosh
