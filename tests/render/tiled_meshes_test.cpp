// Meshes by compute shaders where triangles are hard: the same as by fragments.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/render_test.h"

namespace slosh {
namespace {

class TiledMeshesTest : public RenderTest {
 protected:
  struct Drawn {
    FloatImage depth;
    FloatImage color;
  };
  using Fill = std::function<void(Renderer&, Frame&)>;

  static Drawn draw(PixelPasses way, const Fill& fill) {
    RenderOptions options = small();
    options.quality = Quality::kFull;
    options.pixel_passes = way;
    const auto renderer = make(options);
    Frame frame;
    frame.view = kit::make_view({0.3f, 0.25f, 0.6f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
    fill(*renderer, frame);
    renderer->draw(frame);
    return {renderer->read_buffer(Buffer::kSceneDepth), renderer->read_buffer(Buffer::kFinalColor)};
  }

  /// The largest step in depth from a pixel to one beside it, of those with a mesh, m.
  static float step_at(const FloatImage& depth, int x, int y) {
    const float here = depth.at(x, y);
    if (here >= kNoFluidDepth) return 0.0f;
    float most = 0.0f;
    for (const glm::ivec2 way : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)}) {
      const glm::ivec2 at =
          glm::clamp(glm::ivec2(x, y) + way, glm::ivec2(0), glm::ivec2(kWidth, kHeight) - 1);
      const float there = depth.at(at.x, at.y);
      if (there < kNoFluidDepth) most = std::max(most, std::abs(there - here));
    }
    return most;
  }

  /// A pixel on an edge may be either's; all others are the same to rounding: by fragments a chip has depths
  /// between corners that it put on 256ths of a pixel, which of a triangle that is seen flat from near by is
  /// far. `covered`: pixels with a mesh, at least.
  static void expect_same(const Fill& fill, int covered) {
    const Drawn by_fragments = draw(PixelPasses::kFragments, fill);
    const Drawn by_compute = draw(PixelPasses::kCompute, fill);
    int meshes = 0;
    int depths_off = 0;
    int colors_off = 0;
    for (std::size_t i = 0; i < by_fragments.depth.values.size(); ++i) {
      const float one = by_fragments.depth.values[i];
      const float other = by_compute.depth.values[i];
      meshes += one < kNoFluidDepth ? 1 : 0;
      const auto x = static_cast<int>(i % kWidth);
      const auto y = static_cast<int>(i / kWidth);
      const float rounded = 5e-4f * one + step_at(by_compute.depth, x, y) / 256.0f;
      depths_off += std::abs(one - other) > rounded ? 1 : 0;  // 5e-4: of a floor that goes on behind the eye
      for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
        const float off = std::abs(by_fragments.color.values[c] - by_compute.color.values[c]);
        if (off > 5e-3f * by_fragments.color.values[c] + 1e-3f) {
          ++colors_off;
          break;
        }
      }
    }
    EXPECT_GE(meshes, covered);
    EXPECT_LE(depths_off, 8) << "of " << by_fragments.depth.values.size() << " pixels";
    EXPECT_LE(colors_off, 40) << "of " << by_fragments.depth.values.size()
                              << " pixels: occlusion blurs over 4 × 4";
  }
};

TEST_F(TiledMeshesTest, AFloorGoesOnBehindTheEye) {
  expect_same(
      [](Renderer& renderer, Frame& frame) {
        frame.meshes = {place(renderer, kit::make_box({-30.0f, -0.2f, -30.0f}, {30.0f, -0.1f, 30.0f}))};
        frame.view.far_plane = 20.0f;  // and farther than is seen
      },
      kWidth * kHeight / 2);
}

TEST_F(TiledMeshesTest, AFloorIsAsFarAsItIs) {
  const Drawn drawn = draw(PixelPasses::kCompute, [](Renderer& renderer, Frame& frame) {
    frame.meshes = {place(renderer, kit::make_box({-30.0f, -0.2f, -30.0f}, {30.0f, -0.1f, 30.0f}))};
  });
  const View view = kit::make_view({0.3f, 0.25f, 0.6f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
  const glm::mat4 world_from_eye = glm::inverse(view.view);
  int seen = 0;
  double most = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const glm::vec2 ndc(2.0f * (float(x) + 0.5f) / kWidth - 1.0f,
                          1.0f - 2.0f * (float(y) + 0.5f) / kHeight);
      const glm::vec3 ray(ndc.x / view.projection[0][0], ndc.y / view.projection[1][1], -1.0f);
      const float falls = (glm::mat3(world_from_eye) * ray).y;
      const float depth = (-0.1f - world_from_eye[3].y) / falls;
      if (falls >= 0.0f || depth > 0.9f * view.far_plane) continue;
      ++seen;
      most = std::max(most, double(std::abs(drawn.depth.at(x, y) - depth) / depth));
    }
  }
  EXPECT_GT(seen, kWidth * kHeight / 2);
  EXPECT_LT(most, 1e-5);
}

TEST_F(TiledMeshesTest, TheEyeIsInsideABody) {
  expect_same(
      [](Renderer& renderer, Frame& frame) {
        frame.meshes = {place(renderer, kit::make_box(glm::vec3(-1.0f), glm::vec3(1.0f))),
                        place(renderer, kit::make_sphere(0.1f, 40, 80))};
      },
      kWidth * kHeight);
}

// Of a closed mesh that is seen from outside insides are left out: not where they may be seen.
TEST_F(TiledMeshesTest, InsidesShowWhereAMeshIsOpenMirroredOrCutByTheNearPlane) {
  kit::Shape open = kit::make_box(glm::vec3(-0.1f), glm::vec3(0.1f));
  open.triangles.resize(open.triangles.size() - 2);  // a side
  const auto turned = [](float angle) {
    return glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0.3f, 1.0f, 0.2f));
  };
  for (const float angle : {0.0f, 1.5f, 3.0f, 4.5f}) {
    SCOPED_TRACE(angle);
    expect_same(
        [&](Renderer& renderer, Frame& frame) {
          frame.meshes = {place(renderer, open)};
          frame.meshes[0].model = turned(angle);
        },
        500);
  }
  expect_same(
      [&](Renderer& renderer, Frame& frame) {
        frame.meshes = {place(renderer, kit::make_sphere(0.1f, 12, 24))};
        frame.meshes[0].model = glm::scale(glm::mat4(1.0f), glm::vec3(-1.0f, 1.0f, 1.0f));
      },
      500);
  expect_same(
      [&](Renderer& renderer, Frame& frame) {
        frame.meshes = {place(renderer, kit::make_box({-0.3f, -0.3f, -0.3f}, {0.29f, 0.24f, 0.59f}))};
        frame.view.near_plane = 0.05f;  // the eye is a centimetre off
        frame.view.projection = glm::perspective(0.9f, float(kWidth) / kHeight, 0.05f, frame.view.far_plane);
      },
      1);
}

TEST_F(TiledMeshesTest, ManySmallTrianglesAndSomeThatAreNotSeen) {
  expect_same(
      [](Renderer& renderer, Frame& frame) {
        frame.meshes = {place(renderer, kit::make_sphere(0.12f, 50, 100))};  // 10 000, of a pixel or so
        for (int i = 0; i < 6; ++i) {
          frame.meshes.push_back(frame.meshes.front());
          frame.meshes.back().model =
              glm::translate(glm::mat4(1.0f), glm::vec3(0.3f * float(i - 3), 0.0f, 0.9f));
          frame.meshes.back().mesh = place(renderer, kit::make_sphere(0.05f, 6, 8)).mesh;
        }
      },
      2000);
}

TEST_F(TiledMeshesTest, PanesOfGlassLieOverEachOther) {
  expect_same(
      [](Renderer& renderer, Frame& frame) {
        frame.meshes = {place(renderer, kit::make_box({-0.5f, -0.2f, -0.5f}, {0.5f, -0.13f, 0.5f}))};
        MeshLook glass;
        glass.opacity = 0.3f;
        glass.roughness = 0.4f;
        for (int i = 0; i < 3; ++i) {
          glass.base_color = glm::vec3(i == 0, i == 1, i == 2) * 0.6f + 0.3f;
          frame.meshes.push_back(
              place(renderer, kit::make_tank({-0.1f, -0.1f, -0.1f}, {0.1f, 0.1f, 0.1f}, 0.01f), glass));
          frame.meshes.back().model =
              glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, 0.15f * float(i) - 0.15f));
        }
      },
      5000);
}

TEST_F(TiledMeshesTest, WhatGivesOffLightAndWhatIsMetalLookAlike) {
  expect_same(
      [](Renderer& renderer, Frame& frame) {
        MeshLook look;
        look.emissive = {0.2f, 0.9f, 0.1f};
        frame.meshes = {place(renderer, kit::make_sphere(0.1f, 30, 60), look)};
        look = {};
        look.metallic = 1.0f;
        look.roughness = 0.2f;
        frame.meshes.push_back(
            place(renderer, kit::make_box({-0.3f, -0.2f, -0.3f}, {0.3f, -0.1f, 0.3f}), look));
      },
      4000);
}

TEST_F(TiledMeshesTest, ABodyWithATextureIsDrawnByFragmentsAndGlassWithIt) {
  expect_same(
      [](Renderer& renderer, Frame& frame) {
        const std::vector<std::uint8_t> red_green{255, 0, 0, 255, 0, 255, 0, 255};
        kit::Shape box = kit::make_box({-0.2f, -0.2f, -0.2f}, {0.2f, 0.0f, 0.2f});
        std::vector<glm::vec2> texcoords;
        for (const glm::vec3& p : box.positions) texcoords.emplace_back(2.0f * p.x, 2.0f * p.y);
        MeshLook look;
        look.maps.base_color = renderer.add_texture({2, 1, red_green, false, {}});
        frame.meshes = {
            {renderer.add_mesh(box.positions, box.normals, box.triangles, texcoords), glm::mat4(1.0f), look}};
        MeshLook glass;
        glass.opacity = 0.1f;
        frame.meshes.push_back(
            place(renderer, kit::make_box({-0.05f, 0.0f, -0.05f}, {0.1f, 0.1f, 0.1f}), glass));
      },
      4000);
}

}  // namespace
}  // namespace slosh
