// The renderer as a whole: meshes, glass, arrows, HUD, display, sizes, and bad input.
#include <imgui.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "render/color/display_transform.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

using RendererTest = RenderTest;

double difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

TEST_F(RendererTest, ContextSaysWhatItIs) {
  EXPECT_NE(context_->description().find("4."), std::string::npos);
  EXPECT_FALSE(context_->has_window());
  EXPECT_EQ(context_->native_window(), nullptr);
  EXPECT_FALSE(context_->should_close());
  EXPECT_FALSE(context_->poll().held(Key::kEscape));
}

TEST_F(RendererTest, RefusesBadOptions) {
  const auto refused = [](auto change, const char* field) {
    RenderOptions options = small();
    change(options);
    const auto made = Renderer::create(*context_, options);
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().where.find(field), std::string::npos);
  };
  refused([](RenderOptions& o) { o.width = 0; }, "width");
  refused([](RenderOptions& o) { o.height = 100000; }, "height");
  refused([](RenderOptions& o) { o.bilateral_iterations = -1; }, "bilateral_iterations");
  refused([](RenderOptions& o) { o.bilateral_range = 0.0f; }, "bilateral_range");
  refused([](RenderOptions& o) { o.splat_scale = std::numeric_limits<float>::quiet_NaN(); }, "splat_scale");
  refused([](RenderOptions& o) { o.exposure = -1.0f; }, "exposure");
  refused([](RenderOptions& o) { o.shadow_size = -1; }, "shadow_size");
}

TEST_F(RendererTest, WorksOnAThreadOfItsOwn) {
  Image here;
  Image there;
  const auto picture = [](Context& context) {
    auto renderer = Renderer::create(context, small());
    EXPECT_TRUE(renderer);
    kit::DamBreak scene(*renderer.value(), 500, kWidth, kHeight);
    renderer.value()->draw(scene.frame);
    return renderer.value()->read_back();
  };
  here = picture(*context_);
  std::thread([&] {
    auto own = make_headless_context();
    ASSERT_TRUE(own) << own.error().text();
    there = picture(*own.value());
  }).join();
  EXPECT_EQ(here.rgba, there.rgba);
  EXPECT_EQ(picture(*context_).rgba, here.rgba);  // this thread's context is still current here
}

/// Few pixels of picture under a HUD that has all of a window's: its letters are bitwise identical.
TEST_F(RendererTest, AStretchedPicturesHudIsAsSharpAsTheWindow) {
  const glm::ivec2 window(640, 480);
  const auto hud = [] {
    ImGui::SetNextWindowPos(ImVec2(20, 20));
    ImGui::SetNextWindowSize(ImVec2(300, 100));
    ImGui::SetNextWindowBgAlpha(1.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::Begin("rates", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::Text("1000 Hz, as sharp as the window");
    ImGui::End();
    ImGui::PopStyleVar();
  };
  const auto drawn = [&](glm::ivec2 picture) {
    RenderOptions options = small();
    options.width = picture.x;
    options.height = picture.y;
    auto renderer = make(options);
    kit::DamBreak scene(*renderer, 500, picture.x, picture.y);
    scene.frame.hud = hud;
    renderer->stretch_to(window);
    renderer->draw(scene.frame);
    return renderer->read_back();
  };
  const Image whole = drawn(window);
  const Image half = drawn(window / 2);
  ASSERT_EQ(half.width, window.x);
  ASSERT_EQ(half.height, window.y);
  std::size_t letters = 0, outside = 0;
  for (int y = 0; y < window.y; ++y) {
    for (int x = 0; x < window.x; ++x) {
      const std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(window.x) +
                                  static_cast<std::size_t>(x));
      const bool in_panel = x >= 20 && x < 320 && y >= 20 && y < 120;
      const bool same = std::equal(&whole.rgba[at], &whole.rgba[at] + 3, &half.rgba[at]);
      if (in_panel) {
        EXPECT_TRUE(same) << x << ", " << y;
        letters += whole.rgba[at] > 200;
      } else {
        outside += !same;
      }
    }
  }
  EXPECT_GT(letters, 100u) << "white pixels";
  EXPECT_GT(outside, 1000u) << "the picture itself has fewer pixels";
}

TEST_F(RendererTest, AFrameWithoutAHudIsStretchedToo) {
  auto renderer = make(small());
  renderer->stretch_to({3 * kWidth, 2 * kHeight});
  renderer->draw(empty_frame(kWidth, kHeight));
  EXPECT_EQ(renderer->read_back().width, 3 * kWidth);
  renderer->stretch_to({0, 0});
  renderer->draw(empty_frame(kWidth, kHeight));
  EXPECT_EQ(renderer->read_back().width, kWidth);
}

TEST_F(RendererTest, ReadsBackThePictureItsSize) {
  auto renderer = make(small());
  for (const glm::ivec2 size : {glm::ivec2(kWidth, kHeight), glm::ivec2(33, 17), glm::ivec2(1, 1)}) {
    renderer->resize(size.x, size.y);
    renderer->draw(empty_frame(size.x, size.y));
    const Image image = renderer->read_back();
    EXPECT_EQ(image.width, size.x);
    EXPECT_EQ(image.height, size.y);
    EXPECT_EQ(image.rgba.size(), std::size_t{4} * size.x * size.y);
  }
  renderer->resize(0, -5);
  EXPECT_EQ(renderer->options().width, 1);
}

TEST_F(RendererTest, MeshesStandWhereTheyArePut) {
  auto renderer = make(small());
  Frame frame = empty_frame(kWidth, kHeight);
  MeshInstance ball = place(*renderer, kit::make_sphere(0.1f));
  ball.model = glm::translate(glm::mat4(1.0f), glm::vec3(0.2f, 0.15f, 0.0f));
  frame.meshes = {ball};
  renderer->draw(frame);
  const FloatImage depth = renderer->read_buffer(Buffer::kSceneDepth);
  double sum_x = 0.0;
  double sum_y = 0.0;
  float nearest = 10.0f;
  int count = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (depth.at(x, y) > 5.0f) continue;
      sum_x += x + 0.5;
      sum_y += y + 0.5;
      nearest = std::min(nearest, depth.at(x, y));
      ++count;
    }
  }
  const double scale = 0.5 * kHeight / std::tan(glm::radians(20.0));
  ASSERT_GT(count, 0);
  EXPECT_NEAR(sum_x / count, 0.5 * kWidth + 0.2 * scale, 1.5);
  EXPECT_NEAR(sum_y / count, 0.5 * kHeight - 0.15 * scale, 1.5);  // up in the world is up in the picture
  EXPECT_NEAR(nearest, 0.9f, 2e-3f);
  EXPECT_NEAR(count, M_PI * std::pow(0.1 * scale, 2), 0.06 * count);
}

TEST_F(RendererTest, GlassInFrontOfFluidIsBlendedOverIt) {
  std::vector<glm::vec3> points = kit::jitter_lattice(glm::vec3(-0.15f), glm::vec3(0.15f), 0.02f, 5);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  auto renderer = make(small());
  Frame frame = frame_of(points, fluids, 0.01f);
  renderer->draw(frame);
  const FloatImage plain = renderer->read_buffer(Buffer::kFinalColor);
  MeshLook white;
  white.base_color = glm::vec3(1.0f);
  white.opacity = 0.5f;
  MeshInstance pane = place(*renderer, kit::make_box({-0.05f, -0.3f, 0.3f}, {0.05f, 0.3f, 0.31f}), white);
  frame.meshes = {pane};
  renderer->draw(frame);
  const FloatImage behind_glass = renderer->read_buffer(Buffer::kFinalColor);
  const int cx = kWidth / 2;
  const int cy = kHeight / 2;
  EXPECT_GT(behind_glass.at(cx, cy, 0), plain.at(cx, cy, 0) + 0.1f);
  EXPECT_GT(renderer->read_buffer(Buffer::kThickness).at(cx, cy), 0.0f);  // glass does not hide
  EXPECT_EQ(behind_glass.at(3, cy, 0), plain.at(3, cy, 0));
  // Behind opaque batter the same pane is not seen.
  frame.fluids = {kit::batter()};
  frame.meshes = {};
  renderer->draw(frame);
  const FloatImage batter = renderer->read_buffer(Buffer::kFinalColor);
  pane.model = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, -0.8f));
  frame.meshes = {pane};
  renderer->draw(frame);
  EXPECT_NEAR(renderer->read_buffer(Buffer::kFinalColor).at(cx, cy, 0), batter.at(cx, cy, 0), 1e-3f);
}

TEST_F(RendererTest, ArrowsShowAndAreDimWhenHidden) {
  auto renderer = make(paper());
  Frame frame = empty_frame(kWidth, kHeight);
  const FloatImage none = (renderer->draw(frame), renderer->read_buffer(Buffer::kFinalColor));
  frame.arrows = {{{0.0f, -0.2f, 0.0f}, {0.0f, 0.2f, 0.0f}, {0.0f, 1.0f, 0.0f}}};
  const FloatImage open = (renderer->draw(frame), renderer->read_buffer(Buffer::kFinalColor));
  const int cx = kWidth / 2;
  const int cy = kHeight / 2;
  EXPECT_LT(open.at(cx, cy, 0), 0.5f * none.at(cx, cy, 0));
  MeshLook grey;
  frame.meshes = {place(*renderer, kit::make_box({-0.1f, -0.1f, 0.2f}, {0.1f, 0.1f, 0.21f}), grey)};
  const FloatImage hidden = (renderer->draw(frame), renderer->read_buffer(Buffer::kFinalColor));
  frame.arrows.clear();
  const FloatImage wall = (renderer->draw(frame), renderer->read_buffer(Buffer::kFinalColor));
  const float red = hidden.at(cx, cy, 0) / wall.at(cx, cy, 0);
  EXPECT_LT(red, 0.95f);
  EXPECT_GT(red, 0.5f);
}

TEST_F(RendererTest, TheHudDrawsPixels) {
  auto renderer = make(small());
  Frame frame = empty_frame(kWidth, kHeight);
  renderer->draw(frame);
  const Image without = renderer->read_back();
  int calls = 0;
  frame.hud = [&] {
    ++calls;
    ImGui::SetNextWindowPos(ImVec2(10, 10));
    ImGui::Begin("rates");
    ImGui::Text("1000 Hz");
    ImGui::End();
  };
  renderer->draw(frame);
  renderer->draw(frame);  // a new window is shown from its second frame on
  EXPECT_EQ(calls, 2);
  const Image with = renderer->read_back();
  EXPECT_GT(difference(with, without), 0.5);
  // Top left of the picture, not bottom left.
  double top = 0.0;
  double bottom = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth / 3; ++x) {
      const std::size_t at = std::size_t{4} * (static_cast<std::size_t>(y) * kWidth + x);
      (y < kHeight / 2 ? top : bottom) += std::abs(int{with.rgba[at]} - int{without.rgba[at]});
    }
  }
  EXPECT_GT(top, 10.0 * bottom + 1.0);
}

TEST_F(RendererTest, ThePictureIsTheDisplayTransformOfTheLight) {
  for (Display display : {Display::kAces, Display::kSrgb}) {
    RenderOptions options = small();
    options.display = display;
    options.antialias = false;
    auto renderer = make(options);
    kit::DamBreak scene(*renderer, 800, kWidth, kHeight);
    renderer->draw(scene.frame);
    const FloatImage light = renderer->read_buffer(Buffer::kFinalColor);
    const Image image = renderer->read_back();
    std::vector<glm::vec3> colors;
    for (int i = 0; i < kWidth * kHeight; i += 97) {
      const std::size_t at = std::size_t{3} * static_cast<std::size_t>(i);
      colors.emplace_back(light.values[at], light.values[at + 1], light.values[at + 2]);
    }
    const auto expected = display_colors(display, colors);
    ASSERT_TRUE(expected);
    for (std::size_t k = 0; k < colors.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(image.rgba[4 * 97 * k + static_cast<std::size_t>(c)], 255.0f * expected.value()[k][c],
                    5.0f);
      }
    }
  }
}

TEST_F(RendererTest, TheSameFrameGivesTheSamePicture) {
  Image first;
  for (int run = 0; run < 2; ++run) {
    auto renderer = make(small());
    kit::DamBreak scene(*renderer, 1500, kWidth, kHeight);
    renderer->draw(scene.frame);
    const Image once = renderer->read_back();
    renderer->draw(scene.frame);
    EXPECT_EQ(renderer->read_back().rgba, once.rgba);
    if (run == 0) first = once;
    EXPECT_EQ(once.rgba, first.rgba);
  }
}

TEST_F(RendererTest, BadInputIsLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  auto renderer = make(small());
  std::vector<glm::vec3> good = kit::jitter_lattice(glm::vec3(-0.1f), glm::vec3(0.1f), 0.02f, 5);
  std::vector<std::uint8_t> fluids(good.size(), 0);
  renderer->draw(frame_of(good, fluids, 0.01f));
  const Image expected = renderer->read_back();

  std::vector<glm::vec3> bad = good;
  bad.insert(bad.end(),
             {glm::vec3(nan), glm::vec3(INFINITY), glm::vec3(0.0f, -INFINITY, nan), glm::vec3(1e30f)});
  fluids.resize(bad.size(), 0);
  bad.emplace_back(0.0f, 0.0f, 0.15f);
  fluids.push_back(7);  // no such fluid
  Frame frame = frame_of(bad, fluids, 0.01f);
  frame.arrows = {{glm::vec3(nan), glm::vec3(0.0f), glm::vec3(1.0f)}};
  frame.meshes = {{12345, glm::mat4(1.0f), {}}};
  const glm::uvec3 beyond(0, 1, 99999);
  frame.meshes.push_back({renderer->add_mesh(good, good, std::span(&beyond, 1)), glm::mat4(1.0f), {}});
  frame.meshes.push_back({renderer->add_mesh({}, {}, {}), glm::mat4(1.0f), {}});
  MeshInstance blown_up = place(*renderer, kit::make_sphere(0.1f));
  blown_up.model[3] = glm::vec4(nan, nan, nan, 1.0f);
  frame.meshes.push_back(blown_up);
  renderer->draw(frame);
  EXPECT_EQ(difference(renderer->read_back(), expected), 0.0);
  frame.particle_fluid = frame.particle_fluid.first(3);  // shorter than the particles
  renderer->draw(frame);
  frame.fluids.clear();
  frame.light_direction = glm::vec3(nan);
  renderer->draw(frame);
  frame.particle_radius = nan;
  renderer->draw(frame);
  for (float depth : renderer->read_buffer(Buffer::kFrontDepth).values) ASSERT_EQ(depth, kNoFluidDepth);
  for (float t : renderer->read_buffer(Buffer::kThickness).values) ASSERT_EQ(t, 0.0f);
}

TEST_F(RendererTest, CameraInsideTheFluid) {
  const auto points = kit::jitter_lattice(glm::vec3(-0.4f), glm::vec3(0.4f), 0.04f, 5);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  auto renderer = make(small());
  Frame frame = frame_of(points, fluids, 0.02f);
  frame.view = kit::make_view({0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, kWidth, kHeight);
  renderer->draw(frame);
  for (float value : renderer->read_buffer(Buffer::kFinalColor).values) ASSERT_TRUE(std::isfinite(value));
}

TEST_F(RendererTest, ManyParticles) {
  const auto points = kit::jitter_lattice(glm::vec3(-0.3f), glm::vec3(0.3f), 0.0102f, 5);
  ASSERT_GT(points.size(), 180000u);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  auto renderer = make(small());
  renderer->draw(frame_of(points, fluids, 0.0063f));
  EXPECT_GT(renderer->read_buffer(Buffer::kThickness).at(kWidth / 2, kHeight / 2), 0.55f);
}

TEST_F(RendererTest, PassesAreOnlyThoseTheFrameNeeds) {
  auto renderer = make(small());
  renderer->set_timing(true);
  renderer->draw(empty_frame(kWidth, kHeight));
  const auto ran = [&](const char* name) {
    for (const PassTime& pass : renderer->pass_times()) {
      if (pass.pass == name) return true;
    }
    return false;
  };
  EXPECT_TRUE(ran("display"));
  for (const char* pass : {"front depth", "splats", "composite", "translucent", "arrows", "hud", "window"}) {
    EXPECT_FALSE(ran(pass)) << pass;
  }
  kit::DamBreak scene(*renderer, 300, kWidth, kHeight);
  renderer->draw(scene.frame);
  // By compute shaders they go in stages of several; a stage's name begins with its first pass.
  const auto began = [&](const std::string& name) {
    for (const PassTime& pass : renderer->pass_times()) {
      if (pass.pass.starts_with(name)) return true;
    }
    return false;
  };
  const std::vector<const char*> splats =
      renderer->on_compute() ? std::vector{"splats"} : std::vector{"front depth", "back depth"};
  for (const char* pass : splats) EXPECT_TRUE(began(pass)) << pass;
  for (const char* pass : {"surface filter", "composite", "translucent"}) EXPECT_TRUE(began(pass)) << pass;
}

}  // namespace
}  // namespace slosh
