// Ellipsoids as splats, and thickness by chords: known answers.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/passes/splats.h"
#include "render/shader_math.h"

namespace slosh {
namespace {

/// Where `eye` (eye axes) is in the picture's plane at unit depth.
glm::vec2 seen_at(const glm::vec3& eye) {
  return glm::vec2(eye) / -eye.z;
}

TEST(SplatShape, ABallIsADisc) {
  const glm::mat3 ball(0.04f * 0.04f);
  const SplatShape shape = shape_of(ball, {0.0f, 0.0f, -2.0f});
  EXPECT_NEAR(shape.outline.x, 0.04f, 1e-6f);
  EXPECT_NEAR(shape.outline.y, 0.0f, 1e-6f);
  EXPECT_NEAR(shape.outline.z, 0.04f, 1e-6f);
  EXPECT_NEAR(shape.depth_radius, 0.04f, 1e-6f);
  EXPECT_EQ(shader::ellipsoid_depth(2.0f, shape.tilt, shape.depth_radius, glm::vec2(0.6f, 0.0f), -1.0f),
            shader::sphere_depth(2.0f, shape.depth_radius, glm::vec2(0.6f, 0.0f), -1.0f));
}

TEST(SplatShape, AFlatDiscLiesInItsPlaneAlsoOffTheMiddle) {
  // All points of a thin disc, as the splat has them, are on the plane they should be on as the eye sees it.
  for (const glm::vec3 center : {glm::vec3(0.0f, 0.0f, -1.0f), glm::vec3(0.35f, -0.2f, -1.0f)}) {
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0.8f, 0.6f));
    constexpr float kRadius = 0.01f;
    const glm::mat3 across = glm::mat3(1.0f) - glm::outerProduct(normal, normal);
    const SplatShape shape = shape_of(kRadius * kRadius * across + glm::mat3(1e-10f), center);
    for (int i = 0; i < 8; ++i) {
      const float angle = glm::two_pi<float>() * static_cast<float>(i) / 8.0f;
      const glm::vec2 u(0.9f * std::cos(angle), 0.9f * std::sin(angle));
      const glm::vec2 off(shape.outline.x * u.x, shape.outline.y * u.x + shape.outline.z * u.y);
      const glm::vec2 picture = seen_at(center) + off / -center.z;
      const float depth = shader::ellipsoid_depth(-center.z, shape.tilt, shape.depth_radius, u, -1.0f);
      const glm::vec3 point(picture * depth, -depth);
      EXPECT_NEAR(glm::dot(point - center, normal), 0.0f, 2e-4f) << i;
      EXPECT_NEAR(glm::length(point - center), 0.9f * kRadius, 5e-4f) << i;
    }
  }
}

TEST(SplatShape, AnEdgeOnNeedleDoesNotBreak) {
  const SplatShape shape = shape_of(glm::mat3(0.0f), {0.1f, 0.1f, -1.0f});
  EXPECT_TRUE(
      std::isfinite(shape.outline.x + shape.outline.y + shape.outline.z + shape.tilt.x + shape.tilt.y));
}

TEST(Thickness, AChordEndsAtTheScene) {
  using shader::chord_before;
  EXPECT_FLOAT_EQ(chord_before(1.0f, 0.1f, 0.0f, 5.0f), 0.2f);
  EXPECT_FLOAT_EQ(chord_before(1.0f, 0.1f, 0.36f, 5.0f), 0.16f);
  EXPECT_NEAR(chord_before(1.0f, 0.1f, 0.0f, 0.95f), 0.05f, 1e-6f);
  EXPECT_EQ(chord_before(1.0f, 0.1f, 0.0f, 0.5f), 0.0f);
  EXPECT_EQ(chord_before(1.0f, 0.1f, 1.5f, 5.0f), 0.0f);
}

TEST(Thickness, LayersWithAirBetweenCountByTheirChords) {
  using shader::layered_thickness;
  EXPECT_FLOAT_EQ(layered_thickness(0.1f, 0.1f), 0.1f);
  EXPECT_FLOAT_EQ(layered_thickness(0.1f, 0.085f), 0.1f) << "the sum is noisy, the span is not";
  EXPECT_FLOAT_EQ(layered_thickness(0.1f, 0.2f), 0.1f) << "no more than from the first to the last";
  EXPECT_FLOAT_EQ(layered_thickness(0.5f, 0.04f), 0.04f);
  EXPECT_EQ(layered_thickness(0.0f, 0.0f), 0.0f);
  float before = 0.0f;
  for (float chords = 0.0f; chords <= 0.1f; chords += 0.002f) {
    EXPECT_GE(layered_thickness(0.1f, chords), before);
    before = layered_thickness(0.1f, chords);
  }
}

}  // namespace
}  // namespace slosh
