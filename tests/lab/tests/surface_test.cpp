// What is read from pictures, where the answer is known.
#include "tests/lab/report/surface.h"

#include <gtest/gtest.h>

namespace slosh::report {
namespace {

TEST(ShareOfShape, IsWhatThereIsOfTheFlow) {
  Snapshot before;
  for (int i = 0; i < 20; ++i) before.positions.emplace_back(0.01f * static_cast<float>(i), 0.5f, 0.0f);
  before.fluid_index.assign(20, 0);
  Snapshot now = before;
  const auto shape = [](const glm::dvec3& at) { return glm::dvec2(10.0 * at.x, 1.0); };
  // 0.3 mm of it, and as much across it as it has by itself: sums to nothing along the shape.
  for (std::size_t i = 0; i < 20; ++i) {
    const glm::dvec2 s = shape(glm::dvec3(before.positions[i]));
    const glm::dvec2 way = 3e-4 * s + 1e-4 * glm::dvec2(-s.y, s.x);
    now.positions[i] += glm::vec3(static_cast<float>(way.x), 0.0f, static_cast<float>(way.y));
  }
  now.positions[7] = glm::vec3(1e6f);
  now.fluid_index[7] = kRetired;
  now.positions[8] = glm::vec3(5.0f);  // does not count
  const double share =
      share_of_shape(before, now, [&](std::size_t i, const glm::dvec3& from, const glm::dvec3& to) {
        return i == 8 ? Along{} : Along{{to.x - from.x, to.z - from.z}, shape(from)};
      });
  EXPECT_NEAR(share, 3e-4, 1e-8);
}

TEST(SlopeOf, IsTheNearestLines) {
  EXPECT_NEAR(slope_of({{0.0, 1.0}, {1.0, 3.0}, {2.0, 5.0}}), 2.0, 1e-12);
  EXPECT_NEAR(slope_of({{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}, {3.0, 1.0}}), 0.2, 1e-12);
}

}  // namespace
}  // namespace slosh::report
