// What light does not reach: shadows of bodies and of fluid, creases.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/render_test.h"

namespace slosh {
namespace {

using LightTest = RenderTest;

TEST_F(LightTest, ABallCastsAShadow) {
  for (Quality quality : {Quality::kFast, Quality::kFull}) {
    RenderOptions options = small();
    options.quality = quality;
    options.ambient_occlusion = false;
    auto renderer = make(options);
    Frame frame = empty_frame(kWidth, kHeight);
    frame.view = kit::make_view({0.0f, 0.8f, 0.8f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
    frame.light_direction = {0.0f, -1.0f, 0.0f};
    const MeshInstance floor = place(*renderer, kit::make_box({-0.5f, -0.1f, -0.5f}, {0.5f, 0.0f, 0.5f}));
    MeshInstance ball = place(*renderer, kit::make_sphere(0.1f));
    frame.meshes = {floor};
    renderer->draw(frame);
    const FloatImage lit = renderer->read_buffer(Buffer::kSceneColor);
    ball.model = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.45f, 0.0f));
    frame.meshes = {floor, ball};
    renderer->draw(frame);
    const FloatImage shaded = renderer->read_buffer(Buffer::kSceneColor);
    const int cx = kWidth / 2;
    const int cy = kHeight / 2;  // the floor under the ball; the ball itself is higher up in the picture
    EXPECT_LT(shaded.at(cx, cy, 1), 0.6f * lit.at(cx, cy, 1));
    EXPECT_NEAR(shaded.at(cx - 60, cy, 1), lit.at(cx - 60, cy, 1), 0.02f * lit.at(cx - 60, cy, 1));
  }
}

TEST_F(LightTest, AShadowIsSharpWhereItsBodyTouchesAndSoftFarFromIt) {
  for (Quality quality : {Quality::kFast, Quality::kFull}) {
    RenderOptions options = small();
    options.width = 640;
    options.height = 480;
    options.quality = quality;
    options.ambient_occlusion = false;
    options.environment = even_room();
    options.shadow_size = 512;
    auto renderer = make(options);
    Frame frame = empty_frame(options.width, options.height);
    frame.view = kit::make_view({0.0f, 0.3f, 1e-4f}, {0.0f, 0.0f, 0.0f}, options.width, options.height);
    frame.light_direction = {-1.0f, -1.0f, 0.0f};
    const MeshLook white{glm::vec3(0.8f), 0.0f, 1.0f, 1.0f};
    const MeshInstance floor =
        place(*renderer, kit::make_box({-0.5f, -0.1f, -0.5f}, {0.5f, 0.0f, 0.5f}), white);
    MeshInstance bar = place(*renderer, kit::make_box({0.0f, 0.0f, -0.3f}, {0.05f, 0.002f, 0.3f}), white);
    const float pixel = 2.0f * 0.3f / (frame.view.projection[1][1] * static_cast<float>(options.height));
    // m of the floor, across the shadow's free edge, from a tenth of the light to nine.
    const auto softness = [&](float height) {
      bar.model = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, height, 0.0f));
      frame.meshes = {floor, bar};
      renderer->draw(frame);
      const FloatImage seen = renderer->read_buffer(Buffer::kSceneColor);
      const auto at = [&](float x) {
        return seen.at(options.width / 2 + static_cast<int>(x / pixel), options.height / 2, 1);
      };
      const float lit = at(-height - 0.03f), dark = at(-0.9f * height + 0.012f);
      EXPECT_LT(dark, 0.6f * lit) << height;
      float between = 0.0f;
      float before = 1.0f;
      for (float x = -height - 0.03f; x < -0.9f * height + 0.012f; x += pixel) {
        const float share = (at(x) - dark) / (lit - dark);
        EXPECT_LT(share, before + 0.03f) << "it never grows lighter inwards: " << height << " at " << x;
        before = share;
        if (share > 0.1f && share < 0.9f) between += pixel;
      }
      return between;
    };
    EXPECT_LT(softness(0.015f), 0.0065f) << "no less than a texel to each side";
    // Of a round light's edge 0.687 of the radius to either side; light goes 1.41 times as far and meets the
    // floor at a slant.
    for (const float height : {0.05f, 0.07f})
      EXPECT_NEAR(softness(height), 2.0f * 0.687f * 0.08f * height * 2.0f, 0.004f) << height;
  }
}

TEST_F(LightTest, FluidDimsTheLightPerChannel) {
  RenderOptions options = small();
  auto renderer = make(options);
  // A slab of fluid 0.1 m thick over a floor, seen from beneath its edge so that the floor is not seen
  // through it.
  const float spacing = 0.02f;
  const auto points = kit::jitter_lattice({-0.3f, 0.3f, -0.3f}, {0.301f, 0.401f, 0.301f}, spacing, 3);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.62f * spacing);  // of a ball with a particle's volume
  frame.view = kit::make_view({0.0f, 0.15f, 0.9f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
  frame.light_direction = {0.0f, -1.0f, 0.0f};
  frame.fluids[0].extinction = {20.0f, 5.0f, 0.0f};
  MeshLook white;
  white.base_color = glm::vec3(0.8f);
  white.roughness = 1.0f;
  frame.meshes = {place(*renderer, kit::make_box({-0.8f, -0.1f, -0.8f}, {0.8f, 0.0f, 0.8f}), white)};
  renderer->draw(frame);
  const FloatImage dimmed = renderer->read_buffer(Buffer::kSceneColor);
  ASSERT_EQ(renderer->read_buffer(Buffer::kThickness).at(kWidth / 2, kHeight / 2), 0.0f);
  options.fluid_shadow = false;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(frame);
  const FloatImage lit = renderer->read_buffer(Buffer::kSceneColor);
  // What the sky alone gives: the same floor in the shadow of a roof.
  frame.meshes.push_back(place(*renderer, kit::make_box({-0.8f, 0.7f, -0.8f}, {0.8f, 0.75f, 0.8f})));
  renderer->draw(frame);
  const FloatImage sky = renderer->read_buffer(Buffer::kSceneColor);
  // Over some pixels of the floor: particles lie more densely here than there.
  for (int c = 0; c < 3; ++c) {
    float left = 0.0f;
    float all = 0.0f;
    for (int y = kHeight / 2 - 8; y <= kHeight / 2 + 8; ++y) {
      for (int x = kWidth / 2 - 12; x <= kWidth / 2 + 12; ++x) {
        left += dimmed.at(x, y, c) - sky.at(x, y, c);
        all += lit.at(x, y, c) - sky.at(x, y, c);
      }
    }
    const float share = left / all;
    EXPECT_NEAR(share, std::exp(-0.1f * frame.fluids[0].extinction[c]), 0.05f) << c;
  }
}

TEST_F(LightTest, OcclusionDarkensACreaseAndLittleElse) {
  RenderOptions options = small();
  options.quality = Quality::kFull;
  options.shadow_size = 0;
  auto renderer = make(options);
  Frame frame = empty_frame(kWidth, kHeight);
  frame.view = kit::make_view({0.0f, 0.5f, 1.0f}, {0.0f, 0.1f, 0.0f}, kWidth, kHeight);
  frame.meshes = {place(*renderer, kit::make_box({-1.0f, -0.1f, -1.0f}, {1.0f, 0.0f, 0.5f})),
                  place(*renderer, kit::make_box({-1.0f, 0.0f, -0.3f}, {1.0f, 0.5f, -0.2f}))};
  renderer->draw(frame);
  const FloatImage with = renderer->read_buffer(Buffer::kSceneColor);
  options.ambient_occlusion = false;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(frame);
  const FloatImage without = renderer->read_buffer(Buffer::kSceneColor);
  float lowest = 1.0f;
  for (int y = 0; y < kHeight; ++y)
    lowest = std::min(lowest, with.at(kWidth / 2, y, 1) / without.at(kWidth / 2, y, 1));
  EXPECT_LT(lowest, 0.95f);
  EXPECT_GT(lowest, 0.3f);
  const int open = kHeight - 12;  // the floor far from the wall
  EXPECT_NEAR(with.at(kWidth / 2, open, 1) / without.at(kWidth / 2, open, 1), 1.0f, 0.03f);
}

}  // namespace
}  // namespace slosh
