// Section 5 as drawn: where the fluid is, how it is smoothed, and what Eq 15 makes of it.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/render_test.h"

namespace slosh {
namespace {

using FluidTest = RenderTest;

bool is_fluid(float depth) {
  return depth < 0.5f * kNoFluidDepth;
}

/// Pixels whose centre lies in the disc of some particle, projected here and not on the GPU.
std::vector<bool> projected_discs(const Frame& frame, float splat_radius, int width, int height) {
  std::vector<bool> mask(static_cast<std::size_t>(width) * height, false);
  for (const glm::vec3& particle : frame.particles) {
    const glm::vec4 eye = frame.view.view * glm::vec4(particle, 1.0f);
    const glm::vec4 clip = frame.view.projection * eye;
    const glm::vec2 center((clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(width),
                           (0.5f - clip.y / clip.w * 0.5f) * static_cast<float>(height));
    const float radius =
        splat_radius * frame.view.projection[1][1] / clip.w * 0.5f * static_cast<float>(height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (glm::distance(glm::vec2(x + 0.5f, y + 0.5f), center) <= radius) {
          mask[static_cast<std::size_t>(y) * width + x] = true;
        }
      }
    }
  }
  return mask;
}

template <class Inside>
double overlap(const std::vector<bool>& expected, const FloatImage& image, Inside inside) {
  std::size_t both = 0;
  std::size_t either = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool drawn = inside(image.values[i]);
    both += expected[i] && drawn ? 1 : 0;
    either += expected[i] || drawn ? 1 : 0;
  }
  return either ? static_cast<double>(both) / static_cast<double>(either) : 0.0;
}

/// A ball of particles about `center`.
std::vector<glm::vec3> cluster(const glm::vec3& center, float radius, float spacing) {
  auto points = kit::jitter_lattice(center - radius, center + radius, spacing, 7);
  std::erase_if(points, [&](const glm::vec3& p) { return glm::distance(p, center) > radius; });
  return points;
}

/// A wall of particles `layers` deep whose front is at z = 0, wider than the picture.
std::vector<glm::vec3> wall(int layers, float spacing, float jitter) {
  std::vector<glm::vec3> points;
  unsigned state = 12345;
  const auto noise = [&] {
    state = state * 1664525u + 1013904223u;
    return (static_cast<float>(state >> 8) / 16777216.0f - 0.5f) * jitter * spacing;
  };
  for (int layer = 0; layer < layers; ++layer) {
    const float shift = layer % 2 ? 0.5f * spacing : 0.0f;  // so that no gap goes through
    for (float y = -0.5f + shift; y < 0.5f; y += spacing) {
      for (float x = -0.6f + shift; x < 0.6f; x += spacing) {
        points.emplace_back(x + noise(), y + noise(),
                            -spacing * (static_cast<float>(layer) + 0.5f) + noise());
      }
    }
  }
  return points;
}

TEST_F(FluidTest, PixelsLieWhereTheParticlesAre) {
  auto points = cluster({-0.08f, 0.05f, 0.0f}, 0.1f, 0.02f);
  const auto other = cluster({0.2f, -0.12f, -0.3f}, 0.07f, 0.02f);
  points.insert(points.end(), other.begin(), other.end());
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  const Frame frame = frame_of(points, fluids, 0.01f);
  auto renderer = make(paper());
  renderer->draw(frame);
  const auto expected = projected_discs(frame, 0.012f, kWidth, kHeight);
  EXPECT_GT(std::ranges::count(expected, true), 1500);
  EXPECT_GT(overlap(expected, renderer->read_buffer(Buffer::kFrontDepth), is_fluid), 0.97);
  EXPECT_GT(overlap(expected, renderer->read_buffer(Buffer::kThickness), [](float t) { return t > 0.0f; }),
            0.9);
}

TEST_F(FluidTest, ALoneParticleIsASphere) {
  const std::vector<glm::vec3> points{{0.0f, 0.0f, 0.0f}};
  const std::vector<std::uint8_t> fluids{0};
  const float radius = 0.1f;
  RenderOptions options = paper();
  options.bilateral_iterations = 0;
  options.half_resolution_back = false;
  auto renderer = make(options);
  renderer->draw(frame_of(points, fluids, radius));
  EXPECT_NEAR(renderer->read_buffer(Buffer::kFrontDepth).at(kWidth / 2, kHeight / 2), 1.0f - 1.2f * radius,
              1e-4f);
  EXPECT_NEAR(renderer->read_buffer(Buffer::kBackDepth).at(kWidth / 2, kHeight / 2), 1.0f + 1.2f * radius,
              1e-4f);
  EXPECT_NEAR(renderer->read_buffer(Buffer::kThickness).at(kWidth / 2, kHeight / 2), 2.4f * radius, 2e-4f);
}

TEST_F(FluidTest, ABodyInFrontHidesTheFluid) {
  const auto points = cluster({0.0f, 0.0f, 0.0f}, 0.1f, 0.02f);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.01f);
  auto renderer = make(small());
  frame.meshes = {place(*renderer, kit::make_box({-0.4f, -0.3f, 0.2f}, {0.0f, 0.3f, 0.25f}))};
  renderer->draw(frame);
  const FloatImage thickness = renderer->read_buffer(Buffer::kThickness);
  const FloatImage scene = renderer->read_buffer(Buffer::kSceneDepth);
  int hidden = 0;
  int seen = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (scene.at(x, y) < 0.85f) {
        EXPECT_EQ(thickness.at(x, y), 0.0f);
        ++hidden;
      } else if (thickness.at(x, y) > 0.0f) {
        ++seen;
      }
    }
  }
  EXPECT_GT(hidden, 1000);
  EXPECT_GT(seen, 300);
  EXPECT_NEAR(scene.at(kWidth / 4, kHeight / 2), 0.75f, 1e-3f);
}

TEST_F(FluidTest, WithoutThicknessTheSceneIsCopiedExactly) {
  const auto points = cluster({0.1f, 0.0f, 0.0f}, 0.08f, 0.02f);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.01f);
  auto renderer = make(small());
  frame.meshes = {place(*renderer, kit::make_sphere(0.15f))};
  renderer->draw(frame);
  const FloatImage before = renderer->read_buffer(Buffer::kSceneColor);
  const FloatImage after = renderer->read_buffer(Buffer::kFinalColor);
  const FloatImage thickness = renderer->read_buffer(Buffer::kThickness);
  int changed = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        if (thickness.at(x, y) == 0.0f) {
          ASSERT_EQ(before.at(x, y, c), after.at(x, y, c)) << x << ' ' << y;
        } else if (before.at(x, y, c) != after.at(x, y, c)) {
          ++changed;
        }
      }
    }
  }
  EXPECT_GT(changed, 100);
}

struct Roughness {
  double mean_depth = 0.0;
  double slope = 0.0;  ///< root mean square of the depth's difference from pixel to pixel, m
};

Roughness roughness_of(const FloatImage& depth) {
  Roughness result;
  int count = 0;
  for (int y = 20; y < depth.height - 20; ++y) {
    for (int x = 20; x < depth.width - 20; ++x) {
      const double d = depth.at(x, y);
      EXPECT_TRUE(is_fluid(depth.at(x, y)));
      result.mean_depth += d;
      result.slope += std::pow(depth.at(x + 1, y) - d, 2) + std::pow(depth.at(x, y + 1) - d, 2);
      ++count;
    }
  }
  result.mean_depth /= count;
  result.slope = std::sqrt(result.slope / (2.0 * count));
  return result;
}

TEST_F(FluidTest, TheFilterFlattensASheetAndLeavesItWhereItIs) {
  const float spacing = 0.02f;
  const auto points = wall(4, spacing, 0.3f);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  const Frame frame = frame_of(points, fluids, 0.5f * spacing);
  auto renderer = make(paper());
  renderer->draw(frame);
  const Roughness raw = roughness_of(renderer->read_buffer(Buffer::kFrontDepth));
  const Roughness paper_filter = roughness_of(renderer->read_buffer(Buffer::kSmoothDepth));
  RenderOptions options = paper();
  options.surface = Surface::kOurs;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(frame);
  const Roughness wide = roughness_of(renderer->read_buffer(Buffer::kSmoothDepth));
  EXPECT_LT(paper_filter.slope, 0.6 * raw.slope);
  EXPECT_LT(wide.slope, 0.6 * paper_filter.slope);
  EXPECT_NEAR(paper_filter.mean_depth, raw.mean_depth, 0.1 * spacing);
  EXPECT_NEAR(wide.mean_depth, 1.0, 0.2 * spacing) << "half a spacing before the foremost centres";
}

TEST_F(FluidTest, TheFilterKeepsADepthEdge) {
  auto points = wall(1, 0.02f, 0.0f);
  std::erase_if(points, [](const glm::vec3& p) { return p.x > 0.0f; });
  const std::size_t near_count = points.size();
  for (std::size_t i = 0; i < near_count; ++i)
    points.push_back({-points[i].x + 0.01f, points[i].y, points[i].z - 0.3f});
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  auto renderer = make(small());
  renderer->draw(frame_of(points, fluids, 0.01f));
  const FloatImage depth = renderer->read_buffer(Buffer::kSmoothDepth);
  for (int x = 4; x < kWidth - 4; ++x) {
    const float d = depth.at(x, kHeight / 2);
    EXPECT_TRUE(!is_fluid(d) || std::abs(d - 1.0f) < 0.03f || std::abs(d - 1.3f) < 0.03f) << x << ": " << d;
  }
}

TEST_F(FluidTest, DarkensByExtinctionTimesThickness) {
  for (int layers : {2, 6}) {
    const auto points = wall(layers, 0.02f, 0.2f);
    const std::vector<std::uint8_t> fluids(points.size(), 0);
    Frame frame = frame_of(points, fluids, 0.01f);
    FluidLook look;
    look.color = glm::vec3(0.0f);
    look.extinction = {12.0f, 4.0f, 2.5f};
    look.displacement = 0.0f;
    look.specular = glm::vec3(0.0f);
    frame.fluids = {look};
    auto renderer = make(paper());
    renderer->draw(frame);
    const FloatImage scene = renderer->read_buffer(Buffer::kSceneColor);
    const FloatImage final = renderer->read_buffer(Buffer::kFinalColor);
    const FloatImage thickness = renderer->read_buffer(Buffer::kThickness);
    double mean = 0.0;
    for (int y = 30; y < kHeight - 30; ++y) {
      for (int x = 30; x < kWidth - 30; ++x) {
        const float t = thickness.at(x, y);
        mean += t;
        for (int c = 0; c < 3; ++c) {
          const float expected = std::exp(-t * look.extinction[c]);
          ASSERT_NEAR(final.at(x, y, c) / scene.at(x, y, c), expected, 0.01f);
        }
      }
    }
    mean /= (kHeight - 60.0) * (kWidth - 60.0);
    EXPECT_NEAR(mean, 0.02 * layers, 0.015);
  }
}

TEST_F(FluidTest, SpecularIsBlinnAtTheHalfVector) {
  const auto points = wall(3, 0.02f, 0.0f);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.01f);
  frame.fluids[0].extinction = glm::vec3(1e5f);
  frame.fluids[0].color = glm::vec3(0.0f);
  frame.fluids[0].specular = {0.5f, 0.25f, 0.1f};
  frame.fluids[0].specular_exponent = 2.0f;
  frame.light_direction = {0.0f, 0.0f, -1.0f};
  RenderOptions options = paper();
  options.bilateral_iterations = 40;
  options.surface = Surface::kOurs;
  auto renderer = make(options);
  renderer->draw(frame);
  // Light, eye and normal in one line at the centre: (n·h)^α is one.
  const FloatImage final = renderer->read_buffer(Buffer::kFinalColor);
  EXPECT_NEAR(final.at(kWidth / 2, kHeight / 2, 0), 0.5f, 0.03f);
  EXPECT_NEAR(final.at(kWidth / 2, kHeight / 2, 1), 0.25f, 0.02f);
  EXPECT_LT(final.at(5, 5, 0), final.at(kWidth / 2, kHeight / 2, 0));
}

TEST_F(FluidTest, TheFrontMostParticleBringsItsLook) {
  std::vector<glm::vec3> points = cluster({-0.1f, 0.0f, 0.1f}, 0.06f, 0.02f);
  std::vector<std::uint8_t> fluids(points.size(), 1);
  for (const glm::vec3& p : wall(2, 0.012f, 0.0f)) {
    points.push_back(p - glm::vec3(0.0f, 0.0f, 0.1f));
    fluids.push_back(0);
  }
  Frame frame = frame_of(points, fluids, 0.01f);
  FluidLook red;
  red.color = {1.0f, 0.0f, 0.0f};
  FluidLook green;
  green.color = {0.0f, 1.0f, 0.0f};
  red.extinction = green.extinction = glm::vec3(1e5f);
  red.specular = green.specular = glm::vec3(0.0f);
  frame.fluids = {green, red};
  auto renderer = make(paper());
  renderer->draw(frame);
  const FloatImage index = renderer->read_buffer(Buffer::kFluidIndex);
  const FloatImage final = renderer->read_buffer(Buffer::kFinalColor);
  int of[2] = {0, 0};
  for (int y = 5; y < kHeight - 5; ++y) {
    for (int x = 5; x < kWidth - 5; ++x) {
      const int fluid = static_cast<int>(index.at(x, y));
      ASSERT_TRUE(fluid == 0 || fluid == 1);
      ++of[fluid];
      EXPECT_NEAR(final.at(x, y, 0), fluid == 1 ? 1.0f : 0.0f, 0.01f);
      EXPECT_NEAR(final.at(x, y, 1), fluid == 1 ? 0.0f : 1.0f, 0.01f);
    }
  }
  EXPECT_GT(of[0], 3000);
  EXPECT_GT(of[1], 300);
}

TEST_F(FluidTest, RefractionNeverShowsABodyThatIsInFront) {
  std::vector<glm::vec3> points = cluster({0.0f, 0.0f, 0.0f}, 0.2f, 0.03f);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.015f);
  frame.fluids[0].displacement = 3.0f;
  frame.fluids[0].extinction = glm::vec3(0.0f);
  frame.fluids[0].specular = glm::vec3(0.0f);
  auto renderer = make(paper());
  MeshLook red;
  red.base_color = {1.0f, 0.0f, 0.0f};
  red.roughness = 1.0f;
  MeshInstance bar = place(*renderer, kit::make_box({-0.03f, -0.4f, 0.3f}, {0.03f, 0.4f, 0.32f}), red);
  const auto reddest = [&](const Frame& drawn) {
    renderer->draw(drawn);
    const FloatImage thickness = renderer->read_buffer(Buffer::kThickness);
    const FloatImage final = renderer->read_buffer(Buffer::kFinalColor);
    float most = -1.0f;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (thickness.at(x, y) > 0.0f) most = std::max(most, final.at(x, y, 0) - 2.0f * final.at(x, y, 1));
      }
    }
    return most;
  };
  frame.meshes = {bar};
  EXPECT_LT(reddest(frame), 0.0f);
  // Behind the fluid it is seen.
  bar.model = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, -0.8f));
  frame.meshes = {bar};
  EXPECT_GT(reddest(frame), 0.1f);
}

TEST_F(FluidTest, LeavingOutHiddenParticlesChangesNothing) {
  const auto points = kit::jitter_lattice({-0.25f, -0.2f, -0.3f}, {0.3f, 0.15f, 0.2f}, 0.018f, 11);
  std::vector<std::uint8_t> fluids(points.size());
  for (std::size_t i = 0; i < fluids.size(); ++i) fluids[i] = static_cast<std::uint8_t>(i % 2);
  Frame frame = frame_of(points, fluids, 0.009f);
  frame.fluids = {kit::water(), kit::batter()};
  frame.view = kit::make_view({0.5f, 0.4f, 0.9f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
  RenderOptions options =
      section_five(small());  // ours moves the splats that are left, so the picture may differ
  options.quality = Quality::kFull;
  options.pixel_passes = PixelPasses::kFragments;  // compute shaders place splats themselves, to rounding
  auto renderer = make(options);
  renderer->draw(frame);
  const FloatImage front = renderer->read_buffer(Buffer::kFrontDepth);
  const FloatImage back = renderer->read_buffer(Buffer::kBackDepth);
  options.quality = Quality::kFast;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(frame);
  EXPECT_EQ(renderer->read_buffer(Buffer::kFrontDepth).values, front.values);
  EXPECT_EQ(renderer->read_buffer(Buffer::kBackDepth).values, back.values);
}

TEST_F(FluidTest, BackDepthHasHalfTheSizeWhenAsked) {
  const auto points = cluster({0.0f, 0.0f, 0.0f}, 0.1f, 0.02f);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  auto renderer = make(paper());
  const Frame frame = frame_of(points, fluids, 0.01f);
  renderer->draw(frame);
  const FloatImage half = renderer->read_buffer(Buffer::kBackDepth);
  EXPECT_EQ(half.width, kWidth / 2);
  EXPECT_EQ(half.height, kHeight / 2);
  const float half_thickness = renderer->read_buffer(Buffer::kThickness).at(kWidth / 2, kHeight / 2);
  RenderOptions options = paper();
  options.half_resolution_back = false;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(frame);
  EXPECT_EQ(renderer->read_buffer(Buffer::kBackDepth).width, kWidth);
  EXPECT_NEAR(renderer->read_buffer(Buffer::kThickness).at(kWidth / 2, kHeight / 2), half_thickness, 0.004f);
}

}  // namespace
}  // namespace slosh
