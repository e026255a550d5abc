// Two pictures of one prepared frame, as a headset has them.
#include <imgui.h>

#include <array>
#include <cmath>

#include "tests/render/render_test.h"

namespace slosh {
namespace {

using StereoTest = RenderTest;

TEST_F(StereoTest, EyesOfOneFrameAreAsEachAlone) {
  RenderOptions options = small();
  options.shadow_size = 0;  // its map lies over what both eyes see, and so a little otherwise
  const auto renderer = make(options);
  kit::DamBreak scene(*renderer, 800, kWidth, kHeight);
  std::array<View, 2> eyes{scene.frame.view, scene.frame.view};
  eyes[1].view[3].x -= 0.064f;
  std::array<std::vector<std::uint8_t>, 2> alone;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    scene.frame.view = eyes[eye];
    renderer->draw(scene.frame);
    alone[eye] = renderer->read_back().rgba;
  }
  EXPECT_NE(alone[0], alone[1]);
  int huds = 0;
  scene.frame.hud = [&] { ++huds; };
  renderer->prepare(scene.frame, eyes);
  for (const std::size_t eye : {1, 0}) {
    renderer->draw(eyes[eye]);
    EXPECT_EQ(renderer->read_back().rgba, alone[eye]) << "eye " << eye;
  }
  EXPECT_EQ(huds, 0);
  renderer->draw_hud();
  renderer->present();
  EXPECT_EQ(huds, 1);
}

/// Both at once, in every way that pictures are drawn in.
class StereoTogetherTest : public RenderTest, public ::testing::WithParamInterface<PixelPasses> {};

TEST_P(StereoTogetherTest, EyesDrawnTogetherAreAsEachAlone) {
  for (const bool many_things : {false, true}) {
    SCOPED_TRACE(many_things ? "two fluids that mix, foam, an arrow, caustics" : "one fluid");
    RenderOptions options = small();
    options.quality = Quality::kFull;
    options.pixel_passes = GetParam();
    options.caustics = many_things;
    const auto renderer = make(options);
    kit::DamBreak scene(*renderer, 1500, kWidth, kHeight);
    if (many_things) {
      scene.frame.fluids.push_back(kit::cloudy_juice());
      for (std::size_t i = 0; i < scene.fluids.size() / 2; ++i) scene.fluids[i] = 1;
      scene.frame.arrows = {{{0.1f, 0.06f, 0.02f}, {0.1f, 0.26f, 0.02f}, {0.9f, 0.5f, 0.1f}}};
    }
    std::array<View, 2> eyes{scene.frame.view, scene.frame.view};
    eyes[1].view[3].x -= 0.064f;
    std::array<std::vector<std::uint8_t>, 2> alone;
    std::array<std::vector<float>, 2> depths;
    renderer->prepare(scene.frame, eyes);
    for (std::size_t eye = 0; eye < 2; ++eye) {
      renderer->draw(eyes[eye]);
      alone[eye] = renderer->read_back().rgba;
      depths[eye] = renderer->read_buffer(Buffer::kSmoothDepth).values;
    }
    EXPECT_NE(alone[0], alone[1]);
    for (int picture = 0; picture < 2; ++picture) {  // the second time in what was made the first
      renderer->prepare(scene.frame, eyes);
      renderer->draw(eyes);
      for (std::size_t eye = 0; eye < 2; ++eye)
        EXPECT_EQ(renderer->read_back(eye).rgba, alone[eye]) << "eye " << eye << ", picture " << picture;
      EXPECT_EQ(renderer->read_buffer(Buffer::kSmoothDepth).values, depths[0]);
    }
    // Each has its own HUD.
    int huds = 0;
    scene.frame.hud = [&] {
      ++huds;
      ImGui::GetForegroundDrawList()->AddRectFilled({4.0f, 4.0f}, {20.0f, 20.0f}, IM_COL32(255, 0, 255, 255));
    };
    renderer->prepare(scene.frame, eyes);
    renderer->draw(eyes);
    for (std::size_t eye = 0; eye < 2; ++eye) {
      EXPECT_EQ(renderer->read_back(eye).rgba, alone[eye]) << "eye " << eye;
      renderer->draw_hud(eye);
      EXPECT_NE(renderer->read_back(eye).rgba, alone[eye]) << "eye " << eye;
    }
    EXPECT_EQ(huds, 2);
    scene.frame.hud = {};
    renderer->prepare(scene.frame, eyes);
    // And what is drawn alone after is not the other's.
    renderer->draw(eyes[1]);
    EXPECT_EQ(renderer->read_back().rgba, alone[1]);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryWay, StereoTogetherTest,
                         ::testing::Values(PixelPasses::kFragments, PixelPasses::kCompute));

TEST_F(StereoTest, OneShadowMapServesBothEyes) {
  const auto renderer = make(small());
  kit::DamBreak scene(*renderer, 800, kWidth, kHeight);
  std::array<View, 2> eyes{scene.frame.view, scene.frame.view};
  eyes[1].view[3].x -= 0.064f;
  renderer->prepare(scene.frame, eyes);
  for (const View& eye : eyes) {
    renderer->draw(eye);
    const Image both = renderer->read_back();
    scene.frame.view = eye;
    const auto single = make(small());
    kit::DamBreak same(*single, 800, kWidth, kHeight);
    same.frame.view = eye;
    single->draw(same.frame);
    const Image alone = single->read_back();
    double off = 0.0;
    for (std::size_t i = 0; i < both.rgba.size(); ++i)
      off += std::abs(int{both.rgba[i]} - int{alone.rgba[i]});
    EXPECT_LT(off / static_cast<double>(both.rgba.size()), 0.5)
        << "of 255, a channel: shadow edges alone differ";
    renderer->prepare(scene.frame, eyes);
  }
}

}  // namespace
}  // namespace slosh
