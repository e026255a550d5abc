// What stands still is kept from picture to picture, and nobody can tell.
#include "render/passes/kept_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "tests/render/render_test.h"

namespace slosh {
namespace {

class KeptPictureTest : public RenderTest {};

/// Largest difference of a channel, of 255, and how many differ at all.
struct Difference {
  int most = 0;
  std::size_t count = 0;
};
Difference difference_of(const Image& a, const Image& b) {
  Difference out;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const int off = std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    out.most = std::max(out.most, off);
    out.count += off > 0 ? 1 : 0;
  }
  return out;
}

TEST_F(KeptPictureTest, LooksLikeOneThatIsDrawnWhole) {
  RenderOptions options = small();
  options.quality = Quality::kFast;
  options.pixel_passes = PixelPasses::kFragments;
  const auto kept = make(options);
  options.keep_still = false;
  const auto whole = make(options);
  kit::DamBreak scene(*kept, 1500, kWidth, kHeight);
  const kit::DamBreak same_meshes(*whole, 1500, kWidth, kHeight);
  Frame& frame = scene.frame;
  std::size_t different_from_before = 0;
  Image before;
  const auto check = [&](const char* what) {
    SCOPED_TRACE(what);
    kept->draw(frame);
    whole->draw(frame);
    const Image drawn = kept->read_back();
    const Difference off = difference_of(drawn, whole->read_back());
    EXPECT_EQ(off.most, 0) << off.count << " channels";
    if (!before.rgba.empty()) different_from_before += difference_of(drawn, before).count > 0 ? 1 : 0;
    before = drawn;
  };
  check("the first");
  check("again");
  EXPECT_EQ(different_from_before, 0u) << "and nothing flickers";
  frame.meshes[1].model = glm::translate(glm::mat4(1.0f), glm::vec3(0.13f, 0.09f, 0.0f));
  check("a ball in the fluid moved");
  frame.meshes[2].model = glm::translate(frame.meshes[2].model, glm::vec3(0.01f, 0.02f, 0.0f));
  check("one on the table was lifted: its shadow left");
  for (glm::vec3& p : scene.particles) p.y += 0.01f * std::sin(30.0f * p.x);
  check("fluid moved");
  std::vector<std::uint8_t> shares(8 * 8 * 8, 255);
  const Wetness wet{1, {-0.02f, -0.02f, -0.02f}, 0.02f, 0.005f, {8, 8, 8}, shares, {0, 0, 0}, {8, 8, 8}};
  frame.meshes[0].wet = wet;
  check("a wet spot");
  std::fill(shares.begin(), shares.end(), std::uint8_t{128});
  frame.meshes[0].wet.version = 2;
  check("it dries");
  frame.meshes[0].wet = {};
  check("it is dry");
  frame.arrows = {{{0.1f, 0.06f, 0.02f}, {0.3f, 0.26f, 0.02f}, {0.9f, 0.5f, 0.1f}}};
  check("an arrow");
  frame.arrows.clear();
  check("no arrow");
  const std::vector<FoamPoint> foam{{{0.2f, 0.3f, 0.2f}, 0.01f, 1.0f}};
  frame.foam = foam;
  check("spray");
  frame.foam = {};
  frame.meshes[3].look.base_color = {0.9f, 0.5f, 0.5f};
  check("another glass");
  frame.view = kit::make_view({0.1f, 0.42f, 0.78f}, {0.0f, 0.07f, 0.0f}, kWidth, kHeight);
  check("another eye");
  frame.meshes.pop_back();
  check("no glass");
  frame.particles = {};
  check("no fluid");
  check("nothing moves");
  options.keep_still = true;
  options.exposure = 2.0f;
  ASSERT_TRUE(kept->set_options(options));
  options.keep_still = false;
  ASSERT_TRUE(whole->set_options(options));
  check("other options");
  EXPECT_EQ(different_from_before, 14u) << "each change was seen";
}

TEST_F(KeptPictureTest, AShadowMapIsKeptUntilABodyMoves) {
  RenderOptions options = small();
  options.keep_still = false;
  const auto renderer = make(options);
  const kit::Shape floor = kit::make_box({-1.0f, -0.1f, -1.0f}, {1.0f, 0.0f, 1.0f});
  Frame frame;
  frame.view = kit::make_view({0.0f, 0.8f, 1.0f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
  frame.light_direction = {0.0f, -1.0f, 0.0f};
  frame.meshes = {place(*renderer, floor), place(*renderer, kit::make_sphere(0.1f))};
  const auto light_under_the_ball = [&](float x, float at) {
    frame.meshes[1].model = glm::translate(glm::mat4(1.0f), glm::vec3(x, 0.5f, 0.0f));
    renderer->draw(frame);
    const glm::vec4 clip = frame.view.projection * frame.view.view * glm::vec4(at, 0.0f, 0.0f, 1.0f);
    const glm::vec2 pixel = (glm::vec2(clip) / clip.w + 1.0f) * 0.5f * glm::vec2(kWidth, kHeight);
    return renderer->read_buffer(Buffer::kFinalColor)
        .at(static_cast<int>(pixel.x), kHeight - 1 - static_cast<int>(pixel.y), 0);
  };
  const float dark = light_under_the_ball(-0.4f, -0.4f);
  const float lit = light_under_the_ball(-0.4f, 0.4f);
  EXPECT_LT(dark, 0.7f * lit);
  EXPECT_EQ(light_under_the_ball(-0.4f, -0.4f), dark) << "kept";
  EXPECT_GT(light_under_the_ball(0.4f, -0.4f), 0.9f * lit) << "the ball has gone, its shadow with it";
  frame.meshes[1].look.opacity = 0.1f;
  EXPECT_GT(light_under_the_ball(-0.4f, -0.4f), 0.9f * lit) << "a glass casts none";
}

TEST_F(KeptPictureTest, WhatMovesIsALittleOfThePicture) {
  MeshStore meshes;
  const auto add = [&](const kit::Shape& shape) {
    return meshes.add(shape.positions, shape.normals, shape.triangles);
  };
  Frame frame;
  frame.view = kit::make_view({0.0f, 0.6f, 1.0f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
  frame.meshes = {
      {add(kit::make_box({-0.9f, -0.05f, -0.6f}, {0.9f, 0.0f, 0.6f})), glm::mat4(1.0f), {}},
      {add(kit::make_sphere(0.05f)), glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.1f, 0.0f)), {}}};
  const glm::ivec2 size(kWidth, kHeight);
  KeptPicture kept;
  EXPECT_EQ(kept.changed(frame, meshes, size, 1e-3f).size(), size) << "the first";
  EXPECT_TRUE(kept.changed(frame, meshes, size, 1e-3f).empty());
  frame.meshes[1].model[3].x = 0.1f;
  const PixelBox moved = kept.changed(frame, meshes, size, 1e-3f);
  EXPECT_FALSE(moved.empty());
  EXPECT_LT(moved.size().x * moved.size().y, kWidth * kHeight / 4);
  // Both places, and where light past them meets the table's lower side.
  for (const float x : {0.0f, 0.1f}) {
    for (const glm::vec3 at :
         {glm::vec3(x, 0.1f, 0.0f), glm::vec3(x, 0.1f, 0.0f) + 0.1f * frame.light_direction}) {
      const glm::vec4 clip = frame.view.projection * frame.view.view * glm::vec4(at, 1.0f);
      const glm::vec2 pixel = (glm::vec2(clip) / clip.w + 1.0f) * 0.5f * glm::vec2(size);
      EXPECT_TRUE(pixel.x > moved.low.x && pixel.x < moved.high.x && pixel.y > moved.low.y &&
                  pixel.y < moved.high.y);
    }
  }
  frame.meshes[1].model[3].x = NAN;
  EXPECT_FALSE(kept.changed(frame, meshes, size, 1e-3f).empty()) << "where it was";
  EXPECT_EQ(kept.changed(frame, meshes, size, 2e-3f).size(), size) << "other shadows";
  frame.light_direction.x += 0.1f;
  EXPECT_EQ(kept.changed(frame, meshes, size, 2e-3f).size(), size) << "another light";
  kept.forget();
  EXPECT_EQ(kept.changed(frame, meshes, size, 2e-3f).size(), size);
}

}  // namespace
}  // namespace slosh
