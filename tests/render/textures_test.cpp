// Textures of bodies: what a pixel of llvmpipe's picture and of the path tracer's has, against what is known.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/shader_math.h"
#include "tests/lab/picture/reference/path_tracer.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

using Rgba = std::vector<std::uint8_t>;

float from_srgb(int byte) {
  const float v = static_cast<float>(byte) / 255.0f;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

Rgba texels(std::initializer_list<glm::u8vec4> colors) {
  Rgba bytes;
  for (const glm::u8vec4& c : colors) bytes.insert(bytes.end(), {c.x, c.y, c.z, c.w});
  return bytes;
}

TextureSampling nearest() {
  TextureSampling sampling;
  sampling.shrink = TextureShrink::kNearest;
  sampling.nearest = true;
  return sampling;
}

/// A square of 0.4 m that faces the eye 1 m before it, u to the right and v down.
struct Square {
  std::vector<glm::vec3> positions{{-0.2f, 0.2f, 0}, {0.2f, 0.2f, 0}, {0.2f, -0.2f, 0}, {-0.2f, -0.2f, 0}};
  std::vector<glm::vec3> normals = std::vector<glm::vec3>(4, glm::vec3(0.0f, 0.0f, 1.0f));
  std::vector<glm::uvec3> triangles{{0, 3, 2}, {0, 2, 1}};
  std::vector<glm::vec2> texcoords{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

  MeshInstance in(MeshSink& sink, const MeshLook& look) const {
    return {sink.add_mesh(positions, normals, triangles, texcoords), glm::mat4(1.0f), look};
  }
};

class Textures : public RenderTest {
 protected:
  void SetUp() override {
    RenderOptions options = small();
    options.shadow_size = 0;
    options.ambient_occlusion = false;
    renderer_ = make(options);
  }

  static Frame frame() {
    Frame frame = frame_of({}, {}, 0.01f);
    frame.light_direction = {-0.3f, -0.4f, -1.0f};
    return frame;
  }
  /// Scene-linear, of `square` with `look`.
  FloatImage draw(const MeshLook& look, const Square& square = {}) {
    Frame whole = frame();
    whole.meshes = {square.in(*renderer_, look)};
    renderer_->draw(whole);
    return renderer_->read_buffer(Buffer::kFinalColor);
  }
  /// The pixel that shows the square's texture coordinate (u, v).
  static glm::ivec2 pixel(float u, float v) {
    const float half = std::tan(glm::radians(20.0f));  // of the picture's height, m at 1 m
    const glm::vec2 at((u - 0.5f) * 0.4f / half, (v - 0.5f) * 0.4f / half);
    return {static_cast<int>((0.5f * at.x * kHeight + 0.5f * kWidth)),
            static_cast<int>((0.5f * at.y + 0.5f) * kHeight)};
  }
  static glm::vec3 at(const FloatImage& image, float u, float v) {
    const glm::ivec2 p = pixel(u, v);
    return {image.at(p.x, p.y, 0), image.at(p.x, p.y, 1), image.at(p.x, p.y, 2)};
  }
  TextureHandle texture(int width, int height, const Rgba& rgba, bool srgb,
                        const TextureSampling& sampling = nearest()) {
    return renderer_->add_texture({width, height, rgba, srgb, sampling});
  }
  static void expect_near(const glm::vec3& a, const glm::vec3& b, float slack, const char* what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], slack) << what << ", channel " << c;
  }
  static MeshLook grey() {
    MeshLook look;
    look.base_color = glm::vec3(0.6f);
    look.roughness = 0.7f;
    return look;
  }
  /// What a surface of base colour 0 and 1 shows: light off the surface is a straight line between.
  glm::vec3 expected(const glm::vec3& color, float u, float v) {
    MeshLook look = grey();
    look.base_color = glm::vec3(0.0f);
    const glm::vec3 black = at(draw(look), u, v);
    look.base_color = glm::vec3(1.0f);
    return glm::mix(black, at(draw(look), u, v), color);
  }

  std::unique_ptr<Renderer> renderer_;
};

// Top row red and a middle grey, bottom row dark green and blue, sRGB.
const Rgba kChecker = texels({{255, 0, 0, 255}, {128, 128, 128, 255}, {0, 64, 0, 255}, {0, 0, 255, 255}});

TEST_F(Textures, ABaseColourIsDecodedFromSrgbAndLiesAsGltfHasIt) {
  MeshLook look = grey();
  look.base_color = {1.0f, 0.5f, 1.0f};  // multiplied with the texture
  look.maps.base_color = texture(2, 2, kChecker, true);
  const FloatImage image = draw(look);
  const float middle = from_srgb(128);
  expect_near(at(image, 0.25f, 0.25f), expected({1, 0, 0}, 0.25f, 0.25f), 2e-3f, "top left");
  expect_near(at(image, 0.75f, 0.25f), expected({middle, 0.5f * middle, middle}, 0.75f, 0.25f), 2e-3f,
              "top right");
  expect_near(at(image, 0.25f, 0.75f), expected({0, 0.5f * from_srgb(64), 0}, 0.25f, 0.75f), 2e-3f,
              "bottom left");
  expect_near(at(image, 0.75f, 0.75f), expected({0, 0, 1}, 0.75f, 0.75f), 2e-3f, "bottom right");
}

TEST_F(Textures, ARoomsLightFallsOnThemToo) {
  RenderOptions options = renderer_->options();
  options.environment = make_studio_environment();
  ASSERT_TRUE(renderer_->set_options(options));
  MeshLook look = grey();
  look.base_color = glm::vec3(1.0f);
  look.maps.base_color = texture(2, 2, kChecker, true);
  const FloatImage image = draw(look);
  const float middle = from_srgb(128);
  expect_near(at(image, 0.75f, 0.25f), expected(glm::vec3(middle), 0.75f, 0.25f), 2e-3f, "top right");
  expect_near(at(image, 0.75f, 0.75f), expected({0, 0, 1}, 0.75f, 0.75f), 2e-3f, "bottom right");
}

TEST_F(Textures, BeyondTheirEdgesTheyRepeatMirrorOrStandStill) {
  const Rgba row = texels({{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}});
  Square square;
  for (glm::vec2& t : square.texcoords) t = t * 3.0f - 1.0f;  // −1 to 2
  for (const TextureWrap wrap : {TextureWrap::kRepeat, TextureWrap::kMirror, TextureWrap::kClamp}) {
    for (const bool upright : {false, true}) {
      TextureSampling sampling = nearest();
      (upright ? sampling.wrap_v : sampling.wrap_u) = wrap;
      MeshLook look = grey();
      look.base_color = glm::vec3(0.0f);
      look.roughness = 1.0f;
      look.emissive = glm::vec3(1.0f);
      look.maps.emissive = texture(upright ? 1 : 4, upright ? 4 : 1, row, true, sampling);
      const FloatImage image = draw(look, square);
      for (int texel = -4; texel < 8; ++texel) {
        const float place = (static_cast<float>(texel) + 4.5f) / 12.0f;
        const glm::vec3 seen = upright ? at(image, 0.5f, place) : at(image, place, 0.5f);
        const auto which = static_cast<std::size_t>(wrapped_texel(texel, 4, wrap));
        for (int c = 0; c < 3; ++c) {
          EXPECT_EQ(seen[c] > 0.5f, row[4 * which + static_cast<std::size_t>(c)] > 0)
              << "wrap " << static_cast<int>(wrap) << (upright ? " v" : " u") << " texel " << texel
              << " channel " << c;
        }
      }
    }
  }
}

TEST_F(Textures, SmallOnesAreAveragedAsLight) {
  // A fine checker of black and white: half the light, which is 188 of 255 and not 128.
  constexpr int kSide = 256;
  Rgba fine;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const auto v = static_cast<std::uint8_t>((x + y) % 2 ? 255 : 0);
      fine.insert(fine.end(), {v, v, v, 255});
    }
  Square square;
  for (glm::vec2& t : square.texcoords) t *= 8.0f;
  MeshLook look = grey();
  look.base_color = glm::vec3(1.0f);
  look.maps.base_color = texture(kSide, kSide, fine, true, {});
  const FloatImage averaged = draw(look, square);
  for (const float place : {0.2f, 0.5f, 0.8f})
    expect_near(at(averaged, place, place), expected(glm::vec3(0.5f), place, place), 0.01f, "averaged");
  look.maps.base_color = texture(kSide, kSide, fine, true, nearest());
  const FloatImage rough = draw(look, square);
  const glm::vec3 white = expected(glm::vec3(1.0f), 0.5f, 0.5f),
                  black = expected(glm::vec3(0.0f), 0.5f, 0.5f);
  for (int i = 0; i < 20; ++i) {
    const float seen = at(rough, 0.3f + 0.02f * static_cast<float>(i), 0.5f).y;
    EXPECT_LT(std::min(std::abs(seen - white.y), std::abs(seen - black.y)), 0.02f * white.y) << i;
  }
}

TEST_F(Textures, MagnifiedOnesAreInterpolatedUnlessTheySayNearest) {
  const Rgba two = texels({{0, 0, 0, 255}, {255, 255, 255, 255}});
  MeshLook look = grey();
  look.base_color = glm::vec3(1.0f);
  TextureSampling clamp;
  clamp.wrap_u = TextureWrap::kClamp;
  look.maps.base_color = texture(2, 1, two, true, clamp);
  const FloatImage image = draw(look);
  for (const float u : {0.35f, 0.5f, 0.65f})
    expect_near(at(image, u, 0.5f), expected(glm::vec3(2.0f * u - 0.5f), u, 0.5f), 0.02f, "between");
}

TEST_F(Textures, ANormalMapTurnsTheSurface) {
  // Against the same square whose vertices have the normal that the map says, the square lying four ways on
  // its texture.
  const glm::vec3 tilted = glm::normalize(glm::vec3(0.5f, -0.3f, 0.8f));
  const auto byte = [](float v) {
    return static_cast<std::uint8_t>(std::lround((v * 0.5f + 0.5f) * 255.0f));
  };
  const Rgba one = texels({{byte(tilted.x), byte(tilted.y), byte(tilted.z), 255}});
  struct Way {
    const char* name;
    std::vector<glm::vec2> texcoords;
    glm::vec3 right, up;  // of the texture, on the square
  };
  const std::vector<Way> ways = {{"as it lies", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {1, 0, 0}, {0, 1, 0}},
                                 {"turned", {{0, 1}, {0, 0}, {1, 0}, {1, 1}}, {0, -1, 0}, {1, 0, 0}},
                                 {"mirrored", {{1, 0}, {0, 0}, {0, 1}, {1, 1}}, {-1, 0, 0}, {0, 1, 0}},
                                 {"upside down", {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, {1, 0, 0}, {0, -1, 0}}};
  for (const Way& way : ways) {
    Square square;
    square.texcoords = way.texcoords;
    MeshLook look = grey();
    look.roughness = 0.4f;
    look.maps.normal = texture(1, 1, one, false);
    const glm::vec3 mapped = at(draw(look, square), 0.5f, 0.5f);
    look.maps.normal = kNoTexture;
    const glm::vec3 normal = way.right * tilted.x + way.up * tilted.y + glm::vec3(0, 0, tilted.z);
    square.normals.assign(4, normal);
    const glm::vec3 turned = at(draw(look, square), 0.5f, 0.5f);
    square.normals.assign(4, glm::vec3(0, 0, 1));
    EXPECT_GT(glm::distance(turned, at(draw(look, square), 0.5f, 0.5f)), 0.03f)
        << way.name << ": it makes a difference";
    expect_near(mapped, turned, 6e-3f, way.name);
  }
}

TEST_F(Textures, ANormalMapsScaleAndAFlatOne) {
  MeshLook look = grey();
  const glm::vec3 plain = at(draw(look), 0.5f, 0.5f);
  look.maps.normal = texture(1, 1, texels({{128, 128, 255, 255}}), false);
  expect_near(at(draw(look), 0.5f, 0.5f), plain, 6e-3f, "flat");
  look.maps.normal = texture(1, 1, texels({{255, 128, 128, 255}}), false);
  look.maps.normal_scale = 0.0f;
  expect_near(at(draw(look), 0.5f, 0.5f), plain, 6e-3f, "scaled away");
  // Without texture coordinates there is no direction to turn to.
  Square square;
  square.texcoords.clear();
  look.maps.normal_scale = 1.0f;
  expect_near(at(draw(look, square), 0.5f, 0.5f), plain, 6e-3f, "without coordinates");
}

TEST_F(Textures, MetallicAndRoughnessComeFromBlueAndGreen) {
  MeshLook look = grey();
  look.metallic = 0.8f;
  look.roughness = 0.9f;
  look.maps.metallic_roughness = texture(1, 1, texels({{255, 102, 51, 255}}), false);
  const glm::vec3 mapped = at(draw(look), 0.4f, 0.6f);
  look.maps.metallic_roughness = kNoTexture;
  look.metallic = 0.8f * 0.2f;
  look.roughness = 0.9f * 0.4f;
  expect_near(mapped, at(draw(look), 0.4f, 0.6f), 2e-3f, "numbers");
}

TEST_F(Textures, OcclusionTakesTheLightFromAllAroundAlone) {
  MeshLook look = grey();
  const auto with = [&](int red, float strength) {
    look.maps.occlusion = texture(1, 1, texels({{static_cast<std::uint8_t>(red), 0, 0, 255}}), false);
    look.maps.occlusion_strength = strength;
    return at(draw(look), 0.5f, 0.5f);
  };
  const glm::vec3 open = with(255, 1.0f), shut = with(0, 1.0f), part = with(64, 1.0f), half = with(0, 0.5f);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(shut[c], 0.95f * open[c]);
    EXPECT_GT(shut[c], 0.0f) << "the key light still comes";
    EXPECT_NEAR((part[c] - shut[c]) / (open[c] - shut[c]), 64.0f / 255.0f, 0.01f);
    EXPECT_NEAR((half[c] - shut[c]) / (open[c] - shut[c]), 0.5f, 0.01f);
  }
}

TEST_F(Textures, EmissionIsAddedAndHolesAreSeenThrough) {
  MeshLook look = grey();
  const glm::vec3 dark = at(draw(look), 0.75f, 0.75f);
  look.emissive = {0.0f, 0.0f, 3.0f};
  look.maps.emissive = texture(2, 2, kChecker, true);
  expect_near(at(draw(look), 0.75f, 0.75f) - dark, {0, 0, 3}, 0.01f, "blue");
  expect_near(at(draw(look), 0.25f, 0.25f) - at(draw(grey()), 0.25f, 0.25f), {0, 0, 0}, 0.01f,
              "red shows no blue");
  look = grey();
  look.maps.base_color = texture(2, 1, texels({{255, 255, 255, 100}, {255, 255, 255, 160}}), true);
  look.alpha_cutoff = 0.5f;
  draw(look);
  const FloatImage depth = renderer_->read_buffer(Buffer::kSceneDepth);
  const glm::ivec2 hole = pixel(0.25f, 0.5f), whole = pixel(0.75f, 0.5f);
  EXPECT_GT(depth.at(hole.x, hole.y), 1000.0f);
  EXPECT_NEAR(depth.at(whole.x, whole.y), 1.0f, 1e-3f);
}

TEST_F(Textures, AGlassIsTintedByItsTexture) {
  MeshLook glass;
  glass.opacity = 0.9f;
  glass.roughness = 0.0f;
  glass.base_color = glm::vec3(1.0f);
  glass.maps.base_color = texture(2, 1, texels({{255, 0, 0, 255}, {255, 255, 255, 255}}), true);
  const FloatImage image = draw(glass);
  const glm::vec3 red = at(image, 0.25f, 0.5f), clear = at(image, 0.75f, 0.5f);
  EXPECT_LT(red.y, 0.35f * clear.y);
  EXPECT_GT(red.x, 0.9f * clear.x);
}

TEST_F(Textures, WhatIsNoneIsLeftOut) {
  MeshLook look = grey();
  const glm::vec3 plain = at(draw(look), 0.5f, 0.5f);
  EXPECT_EQ(renderer_->add_texture({2, 2, {}, true, {}}), kNoTexture);
  EXPECT_EQ(renderer_->add_texture({0, 5, kChecker, true, {}}), kNoTexture);
  EXPECT_EQ(renderer_->add_texture({1 << 20, 1, kChecker, true, {}}), kNoTexture);
  look.maps.base_color = 4711;
  look.maps.normal = kNoTexture;
  EXPECT_EQ(at(draw(look), 0.5f, 0.5f), plain);
}

TEST_F(Textures, ThePathTracerSeesTheSame) {
  auto made = reference::PathTracer::create();
  if (!made) GTEST_SKIP() << made.error().text();
  reference::PathTracer& tracer = *made.value();
  const glm::vec3 tilted = glm::normalize(glm::vec3(-0.6f, 0.2f, 0.8f));
  const auto byte = [](float v) {
    return static_cast<std::uint8_t>(std::lround((v * 0.5f + 0.5f) * 255.0f));
  };
  const Rgba bent = texels({{128, 128, 255, 255}, {byte(tilted.x), byte(tilted.y), byte(tilted.z), 255}});
  const Rgba light = texels({{0, 0, 0, 255}, {0, 0, 0, 255}, {0, 0, 0, 255}, {0, 200, 0, 255}});
  const auto shown = [&](MeshSink& sink) {
    MeshLook look = grey();
    look.base_color = glm::vec3(1.0f);
    look.roughness = 1.0f;
    look.emissive = glm::vec3(1.0f);
    look.maps.base_color = sink.add_texture({2, 2, kChecker, true, nearest()});
    look.maps.normal = sink.add_texture({1, 2, bent, false, nearest()});
    look.maps.emissive = sink.add_texture({2, 2, light, true, nearest()});
    Frame whole = frame();
    whole.meshes = {Square{}.in(sink, look)};
    return whole;
  };
  const Frame drawn = shown(*renderer_);
  renderer_->draw(drawn);
  const FloatImage ours = renderer_->read_buffer(Buffer::kFinalColor);
  reference::Options options;
  options.width = kWidth;
  options.height = kHeight;
  options.samples = 24;
  options.threads = 2;
  const FloatImage traced = tracer.draw(shown(tracer), options);
  // Means over each quarter's inside. The rasteriser's light from all around is a formula, the tracer's what
  // comes.
  for (const glm::vec2 quarter :
       {glm::vec2(0.25f, 0.25f), glm::vec2(0.75f, 0.25f), glm::vec2(0.25f, 0.75f), glm::vec2(0.75f, 0.75f)}) {
    glm::vec3 sums[2]{};
    const glm::ivec2 middle = pixel(quarter.x, quarter.y);
    for (int y = -12; y <= 12; ++y)
      for (int x = -12; x <= 12; ++x)
        for (int c = 0; c < 3; ++c) {
          sums[0][c] += ours.at(middle.x + x, middle.y + y, c) / 625.0f;
          sums[1][c] += traced.at(middle.x + x, middle.y + y, c) / 625.0f;
        }
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(sums[0][c], sums[1][c], 0.08f * std::max(sums[1][c], 0.3f))
          << quarter.x << ", " << quarter.y << " channel " << c;
  }
}

TEST(MappedNormal, StaysUnitAndOnItsSide) {
  for (int i = 0; i < 200; ++i) {
    const auto wild = [&](int k) {
      return static_cast<float>((i * 7919 + k * 104729) % 1000) / 500.0f - 1.0f;
    };
    const glm::vec3 n = glm::normalize(glm::vec3(wild(1), wild(2), wild(3)) + glm::vec3(0, 0, 1e-3f));
    const glm::vec3 out = shader::mapped_normal(n, {wild(4), wild(5), wild(6)}, {wild(7), wild(8), wild(9)},
                                                {wild(10), wild(11)}, {wild(12), wild(13)},
                                                glm::vec3(wild(14), wild(15), wild(16)) * 0.5f + 0.5f, 3.0f);
    EXPECT_NEAR(glm::length(out), 1.0f, 1e-4f) << i;
    EXPECT_GT(glm::dot(out, n), 0.0f) << i;
  }
  const glm::vec3 up(0, 0, 1);
  EXPECT_EQ(shader::mapped_normal(up, {1, 0, 0}, {0, 1, 0}, {0, 0}, {0, 0}, {1, 0, 0.5f}, 1.0f), up);
}

}  // namespace
}  // namespace slosh
