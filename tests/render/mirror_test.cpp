// What the fluid's surface mirrors of the bodies: where, how bright, and when not.
#include <algorithm>
#include <cmath>

#include "render/passes/frame_block.h"
#include "render/shader_math.h"
#include "tests/lab/picture/reference/path_tracer.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

using MirrorTest = RenderTest;
using kit::StillBasin;
constexpr float kMirrorSpacing = 0.015f;

/// A line of sight, mirrored in the water's level surface.
struct Mirrored {
  glm::vec3 from{0.0f};
  glm::vec3 way{0.0f};
  float cos_eye = 0.0f;
  bool off_water = false;  ///< or within 80 mm of its edges, where the surface is round
};

Mirrored mirrored_at(const View& view, int x, int y, int width, int height) {
  const glm::vec2 ndc(2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 1.0f,
                      1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
  const glm::mat4 world_from_eye = glm::inverse(view.view);
  const glm::vec3 eye(world_from_eye[3]);
  const glm::vec3 way =
      glm::normalize(glm::mat3(world_from_eye) *
                     glm::vec3(ndc.x / view.projection[0][0], ndc.y / view.projection[1][1], -1.0f));
  Mirrored m;
  m.from = eye - way * (eye.y / way.y);
  m.way = glm::vec3(way.x, -way.y, way.z);
  m.cos_eye = -way.y;
  const glm::vec3 low = StillBasin::kLow + 0.08f;
  const glm::vec3 high = StillBasin::kHigh - 0.08f;
  m.off_water =
      way.y >= 0.0f || m.from.x < low.x || m.from.x > high.x || m.from.z < low.z || m.from.z > high.z;
  return m;
}

/// Where it comes to the post's front, which is larger by `more` on each side; false: it does not.
bool meets_post(const Mirrored& m, float more, glm::vec3& at) {
  const float t = (StillBasin::kPostHigh.z - m.from.z) / m.way.z;
  at = m.from + t * m.way;
  return t > 0.0f && at.x > StillBasin::kPostLow.x - more && at.x < StillBasin::kPostHigh.x + more &&
         at.y < StillBasin::kPostHigh.y + more;
}

glm::vec3 color_at(const FloatImage& image, int x, int y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

TEST_F(MirrorTest, APostStandsInTheWaterUpsideDown) {
  RenderOptions options = small();
  options.width = 320;
  options.height = 240;
  options.quality = Quality::kFull;
  auto renderer = make(options);
  StillBasin basin(*renderer, kMirrorSpacing, options.width, options.height);
  renderer->draw(basin.frame);
  const FloatImage with = renderer->read_buffer(Buffer::kFinalColor);
  const FloatImage scene = renderer->read_buffer(Buffer::kSceneColor);
  options.body_reflections = false;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(basin.frame);
  const FloatImage without = renderer->read_buffer(Buffer::kFinalColor);

  const Studio studio;
  const shader::Room room{studio.sky, studio.horizon, studio.ground, studio.softbox,
                          direction_to_light(basin.frame)};
  const FluidLook& water = basin.frame.fluids[0];
  const shader::FluidMatter matter{water.color, water.extinction, water.scattering,
                                   water.gloss, water.refraction, water.roughness};
  const glm::mat4 clip_from_world = basin.frame.view.projection * basin.frame.view.view;
  int hits = 0;
  int found = 0;
  int misses = 0;
  int false_hits = 0;
  double gained = 0.0;
  double expected = 0.0;
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      const Mirrored m = mirrored_at(basin.frame.view, x, y, options.width, options.height);
      if (m.off_water || m.from.x > 0.02f) continue;  // the ball is on the right
      const glm::vec3 change = color_at(with, x, y) - color_at(without, x, y);
      glm::vec3 at;
      if (!meets_post(m, 0.015f, at) && at.y > 0.05f) {  // below that the basin's own rim is mirrored
        ++misses;
        false_hits += std::abs(change.y) > 0.01f ? 1 : 0;
      }
      if (!meets_post(m, -0.012f, at) || at.y < 0.05f) continue;
      const glm::vec4 clip = clip_from_world * glm::vec4(at, 1.0f);
      const auto px = static_cast<int>((clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(options.width));
      const auto py = static_cast<int>((0.5f - clip.y / clip.w * 0.5f) * static_cast<float>(options.height));
      if (py < 20) continue;  // near the picture's edge it fades
      const float share = shader::fluid_reflectance(matter, m.cos_eye);
      const float right = share * (scene.at(px, py, 1) - shader::room_radiance(room, m.way).y);
      ++hits;
      found += change.y < 0.5f * right ? 1 : 0;
      gained += change.y;
      expected += right;
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(misses, 2000);
  EXPECT_GT(found, 95 * hits / 100) << "of " << hits;
  EXPECT_LT(false_hits, misses / 50) << "of " << misses;
  EXPECT_NEAR(gained / expected, 1.0, 0.1) << "green light that the post hides, by Fresnel's share";
}

TEST_F(MirrorTest, WhatPathsFindIsNearerWithTheBodies) {
  auto tracer = reference::PathTracer::create();
  if (!tracer) GTEST_SKIP() << tracer.error().text();
  RenderOptions options = small();
  options.quality = Quality::kFull;
  reference::Options slow;
  slow.width = options.width;
  slow.height = options.height;
  slow.samples = 24;
  slow.threads = 2;
  StillBasin traced(*tracer.value(), kMirrorSpacing, kWidth, kHeight);
  const FloatImage truth = tracer.value()->draw(traced.frame, slow);
  // In the post's mirror image, on the mean: how red the water is.
  const auto redness = [&](const FloatImage& light) {
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Mirrored m = mirrored_at(traced.frame.view, x, y, kWidth, kHeight);
        glm::vec3 at;
        if (m.off_water || !meets_post(m, -0.01f, at) || at.y < 0.05f || at.y > 0.12f) continue;
        sum += light.at(x, y, 0) - light.at(x, y, 1);
        ++count;
      }
    }
    EXPECT_GT(count, 40);
    return sum / count;
  };
  auto renderer = make(options);
  StillBasin basin(*renderer, kMirrorSpacing, kWidth, kHeight);
  renderer->draw(basin.frame);
  const double with = redness(renderer->read_buffer(Buffer::kFinalColor));
  options.body_reflections = false;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(basin.frame);
  const double without = redness(renderer->read_buffer(Buffer::kFinalColor));
  const double right = redness(truth);
  // The traced surface has ripples as wide as particles, which blur what it mirrors.
  EXPECT_LT(std::abs(with - right), 0.6 * std::abs(without - right))
      << "with " << with << ", without " << without << ", by paths " << right;
}

TEST_F(MirrorTest, ItIsLeftOutWhereNothingIsMirroredAndWhereItMustBeCheap) {
  const auto same = [&](RenderOptions options, bool bodies) {
    std::vector<std::uint8_t> bytes[2];
    for (int on = 0; on < 2; ++on) {
      options.body_reflections = on == 1;
      auto renderer = make(options);
      StillBasin basin(*renderer, 0.02f, kWidth, kHeight);
      if (!bodies) basin.frame.meshes.clear();
      renderer->draw(basin.frame);
      bytes[on] = renderer->read_back().rgba;
    }
    return bytes[0] == bytes[1];
  };
  RenderOptions options = small();
  options.quality = Quality::kFast;
  EXPECT_TRUE(same(options, true));
  options.quality = Quality::kFull;
  EXPECT_TRUE(same(options, false));
  EXPECT_FALSE(same(options, true));
}

}  // namespace
}  // namespace slosh
