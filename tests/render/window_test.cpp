// A real window, where there is a display for one; what there is to say without a display is in
// parts_test.cpp.
#include <gtest/gtest.h>
#include <imgui.h>

#include "render/renderer.h"
#include "tests/render/scene_kit.h"

namespace slosh {
namespace {

TEST(Window, ShowsFrames) {
  if (!display_available()) GTEST_SKIP() << "no display here";
  auto made = make_window_context("slosh test", 200, 150);
  ASSERT_TRUE(made) << made.error().text();
  Context& window = *made.value();
  EXPECT_TRUE(window.has_window());
  EXPECT_NE(window.native_window(), nullptr);
  EXPECT_GE(window.framebuffer_size().x, 1);
  RenderOptions options;
  options.width = 320;
  options.height = 240;
  auto renderer = Renderer::create(window, options);
  ASSERT_TRUE(renderer) << renderer.error().text();
  kit::DamBreak scene(*renderer.value(), 500, options.width, options.height);
  int calls = 0;
  scene.frame.hud = [&] {
    ++calls;
    ImGui::Begin("rates");
    ImGui::Text("1000 Hz");
    ImGui::End();
  };
  for (int i = 0; i < 3; ++i) {
    const InputState& input = window.poll();
    EXPECT_FALSE(input.held(Key::kEscape));
    renderer.value()->draw(scene.frame);
    window.swap();
  }
  EXPECT_EQ(calls, 3);
  EXPECT_FALSE(window.should_close());
  EXPECT_EQ(renderer.value()->read_back().width, 320);
  // Handing the context over and back.
  window.release_current();
  window.make_current();
  renderer.value()->draw(scene.frame);
}

}  // namespace
}  // namespace slosh
