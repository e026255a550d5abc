// The shaders' shared maths, called as the shaders call it.
#include <gtest/gtest.h>

#include <set>

#include "render/shader_math.h"

namespace slosh::shader {
namespace {

TEST(Optics, ThicknessIsWhatLiesBetweenTheSurfacesInFrontOfTheScene) {
  EXPECT_FLOAT_EQ(fluid_thickness(1.0f, 1.5f, 10.0f), 0.5f);
  EXPECT_FLOAT_EQ(fluid_thickness(1.0f, 1.5f, 1.2f), 0.2f);  // a body inside the fluid
  EXPECT_FLOAT_EQ(fluid_thickness(1.0f, 1.5f, 0.8f), 0.0f);  // a body before it
  EXPECT_FLOAT_EQ(fluid_thickness(1.5f, 1.0f, 10.0f), 0.0f);
}

TEST(Optics, TransmittanceMultipliesAlongThePath) {
  const vec3 extinction(12.0f, 4.0f, 2.5f);
  const vec3 one = transmittance(extinction, 0.1f);
  const vec3 two = transmittance(extinction, 0.2f);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(two[k], one[k] * one[k], 1e-6f);
    EXPECT_NEAR(one[k], std::exp(-0.1f * extinction[k]), 1e-6f);
  }
  EXPECT_EQ(transmittance(extinction, 0.0f), vec3(1.0f));
}

TEST(Optics, SeenThroughGoesFromTheSceneToTheFluidsColour) {
  const vec3 fluid(0.1f, 0.3f, 0.5f);
  const vec3 scene(0.9f, 0.8f, 0.7f);
  EXPECT_EQ(seen_through(fluid, scene, vec3(5.0f), 0.0f), scene);
  const vec3 deep = seen_through(fluid, scene, vec3(5.0f), 100.0f);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(deep[k], fluid[k], 1e-6f);
  // Per channel: what is absorbed more shows less of the scene.
  const vec3 shallow = seen_through(vec3(0.0f), vec3(1.0f), vec3(12.0f, 4.0f, 2.5f), 0.1f);
  EXPECT_LT(shallow.x, shallow.y);
  EXPECT_LT(shallow.y, shallow.z);
}

TEST(Optics, BlinnPeaksAtTheHalfVector) {
  const vec3 to_light = normalize(vec3(1.0f, 1.0f, 0.0f));
  const vec3 to_eye = normalize(vec3(-1.0f, 1.0f, 0.0f));
  EXPECT_NEAR(blinn(vec3(0.0f, 1.0f, 0.0f), to_light, to_eye, 180.0f), 1.0f, 1e-5f);
  const vec3 tilted = normalize(vec3(0.1f, 1.0f, 0.0f));
  EXPECT_NEAR(blinn(tilted, to_light, to_eye, 20.0f), std::pow(tilted.y, 20.0f), 1e-5f);
  EXPECT_EQ(blinn(vec3(0.0f, -1.0f, 0.0f), to_light, to_eye, 20.0f), 0.0f);
  EXPECT_EQ(blinn(vec3(0.0f, 1.0f, 0.0f), to_light, -to_light, 20.0f), 0.0f);
}

TEST(Optics, SchlickRunsFromF0ToOne) {
  EXPECT_FLOAT_EQ(schlick(0.02f, 1.0f), 0.02f);
  EXPECT_FLOAT_EQ(schlick(0.02f, 0.0f), 1.0f);
  EXPECT_NEAR(schlick(0.02f, 0.5f), 0.02f + 0.98f * std::pow(0.5f, 5.0f), 1e-6f);
  for (float c = 0.0f; c < 1.0f; c += 0.05f) EXPECT_GT(schlick(0.02f, c), schlick(0.02f, c + 0.05f));
}

TEST(Optics, RefractionIsMeasuredInScreenHeights) {
  const vec2 offset = refraction_offset(vec3(0.5f, 0.5f, 0.7f), 0.35f, 0.2f, 2.0f);
  EXPECT_FLOAT_EQ(offset.y, 0.035f);
  EXPECT_FLOAT_EQ(offset.x, 0.0175f);  // half as much of a picture twice as wide
}

TEST(Sphere, DepthIsTheSpheresSurface) {
  EXPECT_FLOAT_EQ(sphere_depth(2.0f, 0.1f, vec2(0.0f), -1.0f), 1.9f);
  EXPECT_FLOAT_EQ(sphere_depth(2.0f, 0.1f, vec2(0.0f), 1.0f), 2.1f);
  EXPECT_FLOAT_EQ(sphere_depth(2.0f, 0.1f, vec2(0.6f, 0.0f), -1.0f), 1.92f);
  EXPECT_FLOAT_EQ(sphere_depth(2.0f, 0.1f, vec2(1.0f, 0.0f), -1.0f), 2.0f);
}

TEST(Bilateral, TheFourBlocksAndTheCentreAreSeventeenPixels) {
  std::set<std::pair<int, int>> pixels{{0, 0}};
  for (int k = 0; k < 4; ++k) {
    const vec2 middle = bilateral_offset(k);
    for (float x : {-0.5f, 0.5f}) {
      for (float y : {-0.5f, 0.5f}) {
        const vec2 pixel = middle + vec2(x, y);
        EXPECT_EQ(pixel,
                  vec2(std::round(pixel.x), std::round(pixel.y)));  // between texels: a plain mean of four
        pixels.insert({static_cast<int>(pixel.x), static_cast<int>(pixel.y)});
      }
    }
  }
  EXPECT_EQ(pixels.size(), 17u);
  for (const auto& [x, y] : pixels) EXPECT_LE(std::max(std::abs(x), std::abs(y)), 2);
}

TEST(Bilateral, EqualDepthsWeighTwoAndFour) {
  EXPECT_FLOAT_EQ(bilateral_weight(1.0f, 1.0f, 100.0f), 4.0f);
  EXPECT_FLOAT_EQ(bilateral_depth(1.0f, vec4(1.0f), 100.0f), 1.0f);
  // One of four outer samples off by d, with a range so wide that its weight stays 4: moves by 4d / 18.
  EXPECT_NEAR(bilateral_depth(1.0f, vec4(1.009f, 1.0f, 1.0f, 1.0f), 1e-3f), 1.0f + 4.0f * 0.009f / 18.0f,
              1e-6f);
}

TEST(Bilateral, WeightFallsWithTheDifferenceAndEndsAtTheRange) {
  float before = 4.1f;
  for (float off = 0.0f; off < 0.01f; off += 0.001f) {
    const float weight = bilateral_weight(1.0f + off, 1.0f, 100.0f);
    EXPECT_LT(weight, before);
    EXPECT_NEAR(weight, bilateral_weight(1.0f - off, 1.0f, 100.0f), 1e-4f);
    before = weight;
  }
  EXPECT_EQ(bilateral_weight(1.011f, 1.0f, 100.0f), 0.0f);
}

TEST(Bilateral, ASampleWithOneEmptyPixelIsNotUsed) {
  const float mixed = 0.25f * (3.0f * 1.0f + 1.0e6f);
  EXPECT_GT(mixed, kFluidDepthLimit);
  EXPECT_EQ(bilateral_weight(mixed, 1.0f, 100.0f), 0.0f);
  EXPECT_FLOAT_EQ(bilateral_depth(1.0f, vec4(mixed, 1.0e6f, mixed, 1.0e6f), 100.0f), 1.0f);
}

TEST(DisplayShaper, IsMonotonicAndInvertible) {
  EXPECT_NEAR(display_shape(vec3(0.0f)).x, 0.0f, 1e-6f);
  EXPECT_NEAR(display_shape(vec3(kShaperMaximum)).x, 1.0f, 1e-6f);
  float before = -1.0f;
  for (float light = 0.0f; light < 30.0f; light = light * 1.3f + 0.001f) {
    const float at = display_shape(vec3(light)).x;
    EXPECT_GT(at, before);
    EXPECT_NEAR(display_unshape(vec3(at)).x, light, 1e-4f * (1.0f + light));
    before = at;
  }
}

}  // namespace
}  // namespace slosh::shader
