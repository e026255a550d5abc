// What the renderer does on the CPU: shader text, splats, display table, PNG, arrows, the light's box.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "render/color/display_transform.h"
#include "render/gl/shader_source.h"
#include "render/image.h"
#include "render/passes/arrow_pass.h"
#include "render/passes/light_fit.h"
#include "render/passes/splats.h"
#include "render/passes/window_part.h"
#include "render/shader_math.h"
#include "tests/render/scene_kit.h"
#include "tests/support/places.h"

namespace slosh {
namespace {

TEST(ShaderSource, IncludesEachFileOnceAndPutsDefinesFirst) {
  const EmbeddedShader files[] = {{"a", "#include \"b\"\n#include \"c\"\nvoid main() {}\n"},
                                  {"b", "#include \"c\"\nfloat b;\n"},
                                  {"c", "float c;\n"}};
  const auto text = shader_source("a", std::vector<std::string>{"FAST"}, files);
  ASSERT_TRUE(text);
  EXPECT_EQ(text.value(), "#version 450 core\n#define FAST\nfloat c;\nfloat b;\nvoid main() {}\n");
}

TEST(ShaderSource, NamesAMissingFile) {
  const EmbeddedShader files[] = {{"a", "#include \"gone.glsl\"\n"}};
  const auto text = shader_source("a", {}, files);
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().text().find("gone.glsl"), std::string::npos);
}

TEST(WindowPart, IsInThePicturesShape) {
  // An eye that is higher than wide, in a wide window: full height, 538 · 720/605 = 640 columns in the
  // middle.
  const PixelBox eye = window_part({538, 605}, {1280, 720});
  EXPECT_EQ(eye.low, glm::ivec2(320, 0));
  EXPECT_EQ(eye.size(), glm::ivec2(640, 720));
  const PixelBox wide = window_part({600, 100}, {60, 50});
  EXPECT_EQ(wide.low, glm::ivec2(0, 20));
  EXPECT_EQ(wide.size(), glm::ivec2(60, 10));
  // Drawn smaller than the window, in its own shape but for rounding: all of the window.
  for (const glm::ivec2 window : {glm::ivec2(640, 480), glm::ivec2(1281, 721), glm::ivec2(33, 977)}) {
    for (const double scale : {1.0, 0.71, 0.5}) {
      const glm::ivec2 drawn(glm::round(scale * glm::dvec2(window)));
      EXPECT_EQ(window_part(drawn, window).size(), window) << drawn.x << " by " << drawn.y;
    }
  }
}

Frame frame_at(const std::vector<glm::vec3>& particles, const std::vector<std::uint8_t>& fluids) {
  Frame frame;
  frame.view = kit::make_view({0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, 320, 240);
  frame.particles = particles;
  frame.particle_fluid = fluids;
  frame.fluids = {FluidLook{}};
  frame.particle_radius = 0.01f;
  return frame;
}

RenderOptions options_of(int width, int height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  return options;
}

TEST(Splats, LeavesOutWhatCannotBeDrawn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<glm::vec3> particles{{0, 0, 0},   {nan, 0, 0}, {0, inf, 0}, {0, 0, 2},   {0, 0, 0.99f},
                                         {0, 0, -50}, {5, 0, 0},   {0, 0, 0},   {0, 0, 0.1f}};
  const std::vector<std::uint8_t> fluids{0, 0, 0, 0, 0, 0, 0, 255, 1};
  Splats splats;
  prepare_splats(frame_at(particles, fluids), options_of(320, 240), splats);
  ASSERT_EQ(splats.spheres.size(), 1u);
  EXPECT_NEAR(splats.spheres[0].z, -1.0f, 1e-6f);
}

TEST(Splats, TilesCoverTheDiscAndLittleMore) {
  const std::vector<glm::vec3> particles{{0, 0, 0}};
  const std::vector<std::uint8_t> fluids{0};
  Splats splats;
  prepare_splats(frame_at(particles, fluids), options_of(320, 240), splats);
  glm::vec2 low(2.0f);
  glm::vec2 high(-2.0f);
  for (const glm::vec2& corner : splats.tiles) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  const float reach = 1.2f * 0.01f / std::tan(glm::radians(20.0f));  // clip units, vertical
  EXPECT_LE(low.y, -reach);
  EXPECT_GE(high.y, reach);
  // Ours makes ellipsoids of balls that reach 2.15 times as far.
  EXPECT_LE(high.y - low.y, 2.0f * 2.15f * reach + 4.0f * kTileSize / 240.0f);
}

TEST(Splats, MostOfADeepFluidIsHidden) {
  std::vector<glm::vec3> particles = kit::jitter_lattice(glm::vec3(-0.2f), glm::vec3(0.2f), 0.016f, 3);
  const std::vector<std::uint8_t> fluids(particles.size(), 0);
  const Frame frame = frame_at(particles, fluids);
  Splats splats;
  prepare_splats(frame, options_of(640, 480), splats);
  const std::size_t all = splats.spheres.size();
  leave_out_hidden(frame, options_of(640, 480), splats);
  EXPECT_LT(splats.spheres.size(), all / 3);
  EXPECT_LT(splats.back.size(), all / 3);
  EXPECT_GT(splats.spheres.size(), all / 40);
}

TEST(DisplayTransform, KeepsBlackAndGreysInOrder) {
  for (Display display : {Display::kAces, Display::kSrgb}) {
    std::vector<glm::vec3> greys;
    for (float light = 0.0f; light <= 16.0f; light = light * 1.15f + 0.002f) greys.emplace_back(light);
    const auto shown = display_colors(display, greys);
    ASSERT_TRUE(shown) << shown.error().text();
    EXPECT_NEAR(shown.value().front().y, 0.0f, 0.004f);
    for (std::size_t i = 1; i < greys.size(); ++i) {
      const glm::vec3& color = shown.value()[i];
      EXPECT_GE(color.y, shown.value()[i - 1].y);
      EXPECT_NEAR(color.x, color.y, 0.01f);  // a grey stays grey
      EXPECT_NEAR(color.z, color.y, 0.01f);
    }
    EXPECT_GT(shown.value().back().y, 0.97f);
  }
}

TEST(DisplayTransform, PutsMidGreyWhereItsStandardDoes) {
  const glm::vec3 grey(0.18f);
  // IEC 61966-2-1: 1.055 · 0.18^(1/2.4) − 0.055.
  EXPECT_NEAR(display_colors(Display::kSrgb, std::span(&grey, 1)).value()[0].y, 0.4613f, 0.001f);
  // The ACES SDR rendering puts 18 % at about 10 % of the display's light: sRGB 0.35.
  EXPECT_NEAR(display_colors(Display::kAces, std::span(&grey, 1)).value()[0].y, 0.35f, 0.02f);
}

TEST(DisplayTransform, TheTableComesCloseToTheTransform) {
  const int n = kDisplayTableSize;
  for (Display display : {Display::kAces, Display::kSrgb}) {
    const auto table = make_display_table(display);
    ASSERT_TRUE(table);
    ASSERT_EQ(table.value().size(), std::size_t{n} * n * n);
    std::vector<glm::vec3> colors;
    for (float light = 0.003f; light < 8.0f; light *= 1.31f) {
      for (const glm::vec3& tint :
           {glm::vec3(1.0f), glm::vec3(1.0f, 0.4f, 0.2f), glm::vec3(0.1f, 0.35f, 0.55f)}) {
        colors.push_back(light * tint);
      }
    }
    const auto exact = display_colors(display, colors);
    const auto node = [&](const glm::ivec3& i) {
      return table.value()[static_cast<std::size_t>(i.x + n * (i.y + n * i.z))];
    };
    double worst = 0.0;
    for (std::size_t c = 0; c < colors.size(); ++c) {
      const glm::vec3 at = shader::display_shape(colors[c]) * static_cast<float>(n - 1);
      const glm::ivec3 low = glm::min(glm::ivec3(at), glm::ivec3(n - 2));
      glm::vec3 mixed(0.0f);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::vec3 f = glm::mix(1.0f - (at - glm::vec3(low)), at - glm::vec3(low), glm::vec3(step));
        mixed += f.x * f.y * f.z * node(low + step);
      }
      const glm::vec3 off = glm::abs(mixed - exact.value()[c]);
      worst = std::max<double>(worst, std::max({off.x, off.y, off.z}));
    }
    EXPECT_LT(worst, 4.0 / 255.0);
  }
}

TEST(Png, ComesBackAsItWasWritten) {
  Image image{3, 2, {}};
  for (int i = 0; i < 24; ++i) image.rgba.push_back(static_cast<std::uint8_t>(10 * i + 3));
  const std::filesystem::path path = test::build_dir() / "png_comes_back.png";
  const auto written = write_png(path, image);
  ASSERT_TRUE(written) << written.error().text();
  const auto read = read_png(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read.value().width, 3);
  EXPECT_EQ(read.value().height, 2);
  EXPECT_EQ(read.value().rgba, image.rgba);
  std::filesystem::remove(path);
}

TEST(Png, SaysWhatIsWrong) {
  Image image{2, 2, std::vector<std::uint8_t>(16)};
  EXPECT_FALSE(write_png(test::build_dir() / "no such folder" / "a.png", image));
  image.rgba.pop_back();
  EXPECT_FALSE(write_png(test::build_dir() / "short.png", image));
  const std::filesystem::path text = test::build_dir() / "not_a_picture.png";
  std::ofstream(text) << "hello";
  EXPECT_FALSE(read_png(text));
  EXPECT_FALSE(read_png(text.string() + ".gone"));
  std::filesystem::remove(text);
}

TEST(Arrows, SpanTheirEndsAndSkipBadOnes) {
  std::vector<ArrowVertex> out;
  append_arrow({{0, 0, 0}, {0, 0, 0}, {1, 1, 1}}, 1.0f, out);
  append_arrow({{0, 0, 0}, {0, std::numeric_limits<float>::quiet_NaN(), 0}, {1, 1, 1}}, 1.0f, out);
  append_arrow({{std::numeric_limits<float>::infinity(), 0, 0}, {0, 1, 0}, {1, 1, 1}}, 1.0f, out);
  EXPECT_TRUE(out.empty());
  append_arrow({{0.1f, 0, 0}, {0.1f, 0.2f, 0}, {1, 0, 0}}, 1.0f, out);
  ASSERT_FALSE(out.empty());
  float low = 1.0f;
  float high = -1.0f;
  for (const ArrowVertex& vertex : out) {
    low = std::min(low, vertex.position.y);
    high = std::max(high, vertex.position.y);
    EXPECT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f);
  }
  EXPECT_NEAR(low, 0.0f, 1e-6f);
  EXPECT_NEAR(high, 0.2f, 1e-6f);
}

TEST(Shadow, TheLightsBoxHoldsTheScene) {
  Bounds box;
  box.add({-0.7f, -0.1f, -0.4f});
  box.add({0.5f, 0.6f, 0.9f});
  for (const glm::vec3& to_light : {glm::vec3(0, 1, 0), glm::normalize(glm::vec3(0.4f, 1.0f, 0.35f))}) {
    Bounds drop;
    drop.add(2.0f * to_light);
    const Caster scene{box, glm::mat4(1.0f), false};
    const View all = kit::make_view(glm::vec3(0.0f, 0.0f, 6.0f), glm::vec3(0.0f), 100, 100, 90.0f);
    const glm::mat4 clip =
        light_clip_from_world(fit_light(std::span(&scene, 1), drop, std::span(&all, 1), to_light), 512);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 at(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                         corner & 4 ? box.high.z : box.low.z);
      const glm::vec3 seen(clip * glm::vec4(at, 1.0f));
      EXPECT_LE(std::max({std::abs(seen.x), std::abs(seen.y), std::abs(seen.z)}), 1.0f);
    }
    EXPECT_LE(std::abs((clip * glm::vec4(2.0f * to_light, 1.0f)).z), 1.0f);
    // Nearer the light is nearer in the map.
    EXPECT_LT((clip * glm::vec4(to_light * 0.1f, 1.0f)).z, (clip * glm::vec4(-to_light * 0.1f, 1.0f)).z);
  }
}

TEST(Shadow, TheMapIsFittedToWhatCastsAndIsSeen) {
  const glm::vec3 to_light = glm::normalize(glm::vec3(0.4f, 1.0f, 0.35f));
  Caster table;
  table.box.add({-0.9f, -0.05f, -0.9f});
  table.box.add({0.9f, 0.0f, 0.9f});
  table.convex = true;
  Caster cup;
  cup.box.add({-0.1f, 0.0f, -0.1f});
  cup.box.add({0.1f, 0.2f, 0.1f});
  const View view = kit::make_view({0.0f, 0.8f, 1.2f}, glm::vec3(0.0f), 100, 100, 60.0f);
  const auto width = [&](std::initializer_list<Caster> meshes, const View& seen_by) {
    const LightFit fit =
        fit_light(std::span(meshes.begin(), meshes.size()), {}, std::span(&seen_by, 1), to_light);
    return fit.box.high.x - fit.box.low.x;
  };
  const float cup_alone = width({cup}, view);
  EXPECT_FLOAT_EQ(width({table, cup}, view), cup_alone) << "a table only receives";
  Caster below = cup;
  below.model = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, -0.5f, 0.0f));
  EXPECT_GT(width({table, below}, view), 2.0f * cup_alone) << "it casts on what is under it";
  table.convex = false;
  EXPECT_GT(width({table, cup}, view), 2.0f * cup_alone) << "a room casts on itself";
  const View close = kit::make_view({0.0f, 0.25f, 0.05f}, {0.0f, 0.19f, 0.0f}, 100, 100, 20.0f);
  EXPECT_LT(width({cup}, close), 0.8f * cup_alone) << "no texels for what the eye does not see";
  // All that lies below still has its depth in the map: what is outside counts as lit.
  const LightFit fit = fit_light(std::vector<Caster>{table, cup}, {}, std::span(&view, 1), to_light);
  const glm::mat4 clip = light_clip_from_world(fit, 512);
  for (int corner = 0; corner < 8; ++corner)
    EXPECT_LE(std::abs((clip * glm::vec4(box_corner(table.box, corner), 1.0f)).z), 1.0f);
}

TEST(Contexts, RefuseWhatNobodyCanMake) {
  EXPECT_FALSE(make_window_context("none", 0, 100));
  EXPECT_FALSE(make_headless_context({.software_threads = -1}));
}

TEST(Contexts, SayWhyThereIsNoWindow) {
  if (display_available()) GTEST_SKIP() << "a display is here: this is about machines without one";
  const auto window = make_window_context("slosh", 320, 240);
  ASSERT_FALSE(window);
  EXPECT_FALSE(window.error().mend.empty());
  EXPECT_NE(window.error().text().find("display"), std::string::npos);
}

}  // namespace
}  // namespace slosh
