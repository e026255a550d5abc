// Edges of the picture as shown: the shader's decisions, and what becomes of a slanted line.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/passes/edges_on_cpu.h"
#include "render/shader_math.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

using shader::Corners;
using shader::Cross;

TEST(Edges, ShadingIsNone) {
  EXPECT_FALSE(shader::has_edge(Cross{0.5f, 0.51f, 0.49f, 0.52f, 0.48f}));
  EXPECT_FALSE(shader::has_edge(Cross{0.02f, 0.05f, 0.02f, 0.02f, 0.02f})) << "nor is noise in the dark";
  EXPECT_TRUE(shader::has_edge(Cross{0.5f, 0.7f, 0.5f, 0.5f, 0.5f}));
}

TEST(Edges, AStepIsLevelOrUpright) {
  const Cross level{0.0f, 1.0f, 0.0f, 0.0f, 0.0f};
  EXPECT_TRUE(shader::edge_is_level(level, Corners{1.0f, 1.0f, 0.0f, 0.0f}));
  const Cross upright{0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
  EXPECT_FALSE(shader::edge_is_level(upright, Corners{0.0f, 1.0f, 0.0f, 1.0f}));
}

TEST(Edges, TheNearerEndSaysHowMuchIsTheOtherSides) {
  // Dark below, bright above the row; the edge rises by one row over eight pixels, so it ends by turning
  // bright.
  const Cross c{0.0f, 1.0f, 0.0f, 0.0f, 0.0f};
  const Corners k{1.0f, 1.0f, 0.0f, 0.0f};
  const auto share = [&](float ahead, float back) {
    return shader::other_share(c, k, 0.5f, {ahead, 0.5f}, {back, -0.5f});
  };
  EXPECT_NEAR(share(1.0f, 7.0f), 0.5f - 1.0f / 8.0f, 1e-6f);
  EXPECT_NEAR(share(2.0f, 6.0f), 0.25f, 1e-6f);
  const float flat = shader::other_share(c, k, 0.5f, {12.0f, 0.0f}, {12.0f, 0.0f});
  EXPECT_LT(flat, 0.08f) << "an edge between rows is sharp as it is";
  EXPECT_NEAR(share(7.0f, 1.0f), flat, 1e-6f) << "the edge has left this row where it turns dark";
}

TEST(Edges, OnACpuTheyBecomeSmoothToo) {
  // A slanted line by hand, dark below: its stairs' columns differ less afterwards; what has no edge stays.
  constexpr int kSide = 40;
  std::vector<std::uint8_t> picture(std::size_t{4} * kSide * kSide, 255);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (std::size_t c = 0; c < 3; ++c)
        picture[4 * static_cast<std::size_t>(y * kSide + x) + c] = y < 10 + x / 5 ? 20 : 220;
    }
  }
  std::vector<float> scratch;
  std::vector<std::uint8_t> smooth;
  smooth_edges(picture, {kSide, kSide}, {}, scratch, smooth);
  ASSERT_EQ(smooth.size(), picture.size());
  const auto column = [&](const std::vector<std::uint8_t>& image, int x) {
    double sum = 0.0;
    for (int y = 0; y < kSide; ++y)
      sum += (220.0 - image[4 * static_cast<std::size_t>(y * kSide + x)]) / 200.0;
    return sum - (10.0 + (x - 2.0) / 5.0);
  };
  double before = 0.0, after = 0.0;
  for (int x = 10; x < 30; ++x) {
    before += std::abs(column(picture, x)) / 20.0;
    after += std::abs(column(smooth, x)) / 20.0;
  }
  EXPECT_NEAR(before, 0.24, 0.01);
  EXPECT_LT(after, 0.5 * before);
  for (int x = 0; x < kSide; ++x) {
    EXPECT_EQ(smooth[4 * static_cast<std::size_t>(2 * kSide + x)], 20);
    EXPECT_EQ(smooth[4 * static_cast<std::size_t>(35 * kSide + x)], 220);
  }
}

class EdgePictures : public RenderTest {
 protected:
  /// A dark plate over a bright background, its upper side at a slant; greys along the columns.
  Image plate(bool antialias, float slant) {
    RenderOptions options = small();
    options.antialias = antialias;
    options.shadow_size = 0;
    options.environment = even_room();
    auto renderer = make(options);
    MeshLook black;
    black.base_color = glm::vec3(0.0f);
    black.roughness = 1.0f;
    Frame frame = frame_of({}, {}, 0.01f);
    MeshInstance box = place(*renderer, kit::make_box({-3.0f, -3.0f, -0.1f}, {3.0f, 0.0f, 0.0f}), black);
    box.model = glm::rotate(glm::mat4(1.0f), std::atan(slant), glm::vec3(0.0f, 0.0f, 1.0f));
    frame.meshes = {box};
    renderer->draw(frame);
    return renderer->read_back();
  }
};

/// By how much a column's sum of greys is off the line it should be on: the mean over columns, pixels.
double off_line(const Image& image) {
  std::vector<double> covered;
  const auto grey = [&](int x, int y) {
    return static_cast<double>(image.rgba[std::size_t{4} * (static_cast<std::size_t>(y) * image.width + x)]);
  };
  for (int x = 20; x < image.width - 20; ++x) {
    double sum = 0.0;
    const double bright = grey(x, 20);
    const double dark = grey(x, image.height - 20);
    for (int y = 20; y < image.height - 20; ++y) sum += (grey(x, y) - dark) / (bright - dark);
    covered.push_back(sum);
  }
  // The best line through them.
  const auto n = static_cast<double>(covered.size());
  double mean = 0.0, slope = 0.0, square = 0.0;
  for (const double c : covered) mean += c / n;
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const double x = static_cast<double>(i) - 0.5 * (n - 1.0);
    slope += x * (covered[i] - mean);
    square += x * x;
  }
  slope /= square;
  double off = 0.0;
  for (std::size_t i = 0; i < covered.size(); ++i)
    off += std::abs(covered[i] - mean - slope * (static_cast<double>(i) - 0.5 * (n - 1.0))) / n;
  return off;
}

TEST_F(EdgePictures, ASlantedEdgeLosesItsStairs) {
  for (const float slant : {0.1f, 0.2f, 0.4f}) {
    const double before = off_line(plate(false, slant));
    const double after = off_line(plate(true, slant));
    EXPECT_GT(before, 0.15) << slant;
    EXPECT_LT(after, 0.77 * before) << slant;  // 0.753 on an H100
  }
}

TEST_F(EdgePictures, WhatHasNoEdgesStays) {
  RenderOptions options = small();
  options.antialias = false;
  auto renderer = make(options);
  renderer->draw(frame_of({}, {}, 0.01f));
  const Image before = renderer->read_back();
  options.antialias = true;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(frame_of({}, {}, 0.01f));
  EXPECT_EQ(renderer->read_back().rgba, before.rgba);
}

}  // namespace
}  // namespace slosh
