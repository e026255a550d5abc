// Two pictures of one prepared frame, as a headset has them.
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
