// What a fluid and a glass look like where pictures went wrong before: outlines, thin places, shadows, panes.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

#include "render/shader_math.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

using LooksTest = RenderTest;

float luma(const FloatImage& image, int x, int y) {
  return 0.2126f * image.at(x, y, 0) + 0.7152f * image.at(x, y, 1) + 0.0722f * image.at(x, y, 2);
}

/// The fluid goes on at all eight neighbours.
bool inside_outline(const FloatImage& thickness, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (thickness.at(x + dx, y + dy) <= 0.0f) return false;
    }
  }
  return true;
}

TEST_F(LooksTest, OutlinesHaveNoWhiteCrumbs) {
  // Black fluid before black: what is bright is mirrored.
  auto points = kit::jitter_lattice(glm::vec3(-0.2f), glm::vec3(0.2f), 0.02f, 7);
  std::erase_if(points, [](const glm::vec3& p) { return glm::length(p) > 0.2f; });
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.01f);
  frame.fluids[0].color = glm::vec3(0.0f);
  frame.fluids[0].extinction = glm::vec3(1e5f);
  RenderOptions options = small();
  options.draw_background = false;
  auto renderer = make(options);
  renderer->draw(frame);
  const FloatImage thickness = renderer->read_buffer(Buffer::kThickness);
  const FloatImage light = renderer->read_buffer(Buffer::kFinalColor);
  int outline = 0;
  int bright = 0;
  for (int y = 1; y < kHeight - 1; ++y) {
    for (int x = 1; x < kWidth - 1; ++x) {
      if (thickness.at(x, y) <= 0.0f || inside_outline(thickness, x, y)) continue;
      ++outline;
      bright += luma(light, x, y) > 0.2f ? 1 : 0;
    }
  }
  EXPECT_GT(outline, 100);
  EXPECT_LE(bright, outline / 50);
}

TEST_F(LooksTest, NoPixelIsLostWhereTheFilterPassesTheBack) {
  const auto points = kit::jitter_lattice({-0.4f, -0.3f, -0.1f}, {0.4f, 0.3f, 0.1f}, 0.04f, 9);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  const Frame frame = frame_of(points, fluids, 0.01f);
  const auto lost = [&](const RenderOptions& options) {
    auto renderer = make(options);
    renderer->draw(frame);
    const FloatImage raw = renderer->read_buffer(Buffer::kFrontDepth);
    const FloatImage thickness = renderer->read_buffer(Buffer::kThickness);
    int count = 0;
    for (std::size_t i = 0; i < raw.values.size(); ++i)
      count += raw.values[i] < 0.5f * kNoFluidDepth && thickness.values[i] <= 0.0f ? 1 : 0;
    return count;
  };
  EXPECT_GT(lost(paper()), 20) << "section 5 as it stands loses some: the test sees them";
  EXPECT_EQ(lost(small()), 0);
}

TEST_F(LooksTest, APoolLiesInTheShadowOfFluidAboveIt) {
  auto pool = kit::jitter_lattice({-0.4f, -0.1f, -0.4f}, {0.4f, 0.0f, 0.4f}, 0.02f, 3);
  const auto sheet = kit::jitter_lattice({-0.1f, 0.5f, -0.1f}, {0.1f, 0.54f, 0.1f}, 0.02f, 4);
  std::vector<glm::vec3> both = pool;
  both.insert(both.end(), sheet.begin(), sheet.end());
  const std::vector<std::uint8_t> fluids(both.size(), 0);
  auto renderer = make(small());
  Frame frame = frame_of(pool, fluids, 0.01f);
  frame.view = kit::make_view({0.0f, 0.35f, 0.9f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
  frame.light_direction = {0.0f, -1.0f, 0.0f};
  frame.fluids = {kit::batter()};
  frame.fluids[0].gloss = 0.0f;
  frame.meshes = {place(*renderer, kit::make_box({-0.5f, -0.2f, -0.5f}, {0.5f, -0.12f, 0.5f}))};
  renderer->draw(frame);
  const FloatImage lit = renderer->read_buffer(Buffer::kFinalColor);
  frame.particles = both;
  renderer->draw(frame);
  const FloatImage shaded = renderer->read_buffer(Buffer::kFinalColor);
  const int x = kWidth / 2;
  const int y = kHeight / 2;
  EXPECT_LT(luma(shaded, x, y), 0.6f * luma(lit, x, y));
  EXPECT_GT(luma(shaded, x, y), 0.1f * luma(lit, x, y)) << "the sky still lights it";
  EXPECT_NEAR(luma(shaded, x - 70, y), luma(lit, x - 70, y), 0.1f * luma(lit, x - 70, y)) << "beside it";
}

TEST_F(LooksTest, AShadowOnFluidHasSoftEdges) {
  auto points = kit::jitter_lattice({-0.4f, -0.1f, -0.4f}, {0.4f, 0.0f, 0.4f}, 0.02f, 3);
  const std::size_t pool = points.size();
  const auto sheet = kit::jitter_lattice({-0.1f, 0.5f, -0.1f}, {0.1f, 0.54f, 0.1f}, 0.02f, 4);
  points.insert(points.end(), sheet.begin(), sheet.end());
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  RenderOptions options = small();
  options.quality = Quality::kFast;
  auto renderer = make(options);
  Frame frame = frame_of(points, fluids, 0.01f);
  // A texel of the shadow's map is several pixels.
  frame.view = kit::make_view({-0.1f, 0.3f, 0.25f}, {-0.1f, 0.0f, 0.0f}, kWidth, kHeight, 20.0f);
  frame.light_direction = {0.0f, -1.0f, 0.0f};
  frame.fluids = {kit::batter()};
  frame.fluids[0].gloss = 0.0f;
  frame.meshes = {place(*renderer, kit::make_box({-0.5f, -0.2f, -0.5f}, {0.5f, -0.12f, 0.5f}))};
  const auto light = [&](std::size_t drawn) {
    frame.particles = std::span(points).first(drawn);
    renderer->draw(frame);
    return renderer->read_buffer(Buffer::kFinalColor);
  };
  const FloatImage lit = light(pool);
  const FloatImage shaded = light(points.size());
  int whole = 0;  // pixels in the shadow, and on its edge
  int edge = 0;
  for (int y = kHeight / 4; y < 3 * kHeight / 4; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float left = luma(shaded, x, y) / luma(lit, x, y);
      whole += left < 0.62f ? 1 : 0;
      edge += left > 0.7f && left < 0.9f ? 1 : 0;
    }
  }
  EXPECT_GT(whole, kWidth * kHeight / 8);
  EXPECT_GT(edge, kHeight / 2) << "more than a pixel a row";
}

TEST_F(LooksTest, TwoSheetsWithAirBetweenAreAsThickAsTheyAre) {
  auto both = kit::jitter_lattice({-0.3f, -0.25f, -0.04f}, {0.3f, 0.25f, 0.0f}, 0.01f, 3);
  const std::size_t one = both.size();
  const auto behind = kit::jitter_lattice({-0.4f, -0.35f, -0.34f}, {0.4f, 0.35f, -0.30f}, 0.01f, 4);
  both.insert(both.end(), behind.begin(), behind.end());
  const std::vector<std::uint8_t> fluids(both.size(), 0);
  Frame frame = frame_of(both, fluids, 0.0062f);
  const auto mean_thickness = [&](const RenderOptions& options) {
    auto renderer = make(options);
    renderer->draw(frame);
    const FloatImage thickness = renderer->read_buffer(Buffer::kThickness);
    double sum = 0.0;
    for (int y = 40; y < kHeight - 40; ++y) {
      for (int x = 50; x < kWidth - 50; ++x) sum += thickness.at(x, y);
    }
    return sum / ((kHeight - 80.0) * (kWidth - 100.0));
  };
  EXPECT_NEAR(mean_thickness(small()), 0.08, 0.012);
  RenderOptions span = small();
  span.layers = false;
  EXPECT_GT(mean_thickness(span), 0.3) << "back less front has the air in it";
  EXPECT_GT(mean_thickness(paper()), 0.3) << "and so has section 5 as it stands";
  frame.particles = std::span(both).first(one);
  EXPECT_NEAR(mean_thickness(small()), 0.04, 0.006);
  EXPECT_NEAR(mean_thickness(span), mean_thickness(small()), 2e-4)
      << "one layer: the span, which has no noise";
}

TEST_F(LooksTest, AWallBetweenSheetsHidesTheFarOne) {
  auto both = kit::jitter_lattice({-0.3f, -0.25f, -0.04f}, {0.3f, 0.25f, 0.0f}, 0.01f, 3);
  const auto behind = kit::jitter_lattice({-0.4f, -0.35f, -0.34f}, {0.4f, 0.35f, -0.30f}, 0.01f, 4);
  both.insert(both.end(), behind.begin(), behind.end());
  const std::vector<std::uint8_t> fluids(both.size(), 0);
  Frame frame = frame_of(both, fluids, 0.0062f);
  auto renderer = make(small());
  frame.meshes = {place(*renderer, kit::make_box({-1.0f, -1.0f, -0.25f}, {1.0f, 1.0f, -0.2f}))};
  renderer->draw(frame);
  EXPECT_NEAR(renderer->read_buffer(Buffer::kThickness).at(kWidth / 2, kHeight / 2), 0.04f, 0.01f);
}

TEST_F(LooksTest, ADropsShadowIsRoundAlsoInItsTop) {
  // A plate over a pool, and a drop above the plate. The corner of the drop's square reaches over the plate's
  // middle; if it counted, the fluid under the plate would darken it.
  const float radius = 0.06f;
  auto points = kit::jitter_lattice({-0.3f, -0.3f, -0.3f}, {0.3f, -0.2f, 0.3f}, 0.06f, 3);
  const std::size_t pool = points.size();
  const float off = 0.85f * 1.25f * 1.2f * radius;
  points.emplace_back(off, 0.3f, off);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  auto renderer = make(small());
  Frame frame = frame_of(points, fluids, radius);
  frame.view = kit::make_view({0.0f, 0.8f, 0.4f}, {0.0f, 0.0f, 0.0f}, kWidth, kHeight);
  frame.light_direction = {0.0f, -1.0f, 0.0f};
  frame.fluids[0].extinction = glm::vec3(100.0f);
  frame.meshes = {place(*renderer, kit::make_box({-0.35f, -0.02f, -0.35f}, {0.35f, 0.0f, 0.35f}))};
  renderer->draw(frame);
  const FloatImage with = renderer->read_buffer(Buffer::kSceneColor);
  frame.particles = std::span(points).first(pool);
  renderer->draw(frame);
  const FloatImage without = renderer->read_buffer(Buffer::kSceneColor);
  EXPECT_NEAR(luma(with, kWidth / 2, kHeight / 2), luma(without, kWidth / 2, kHeight / 2),
              0.05f * luma(without, kWidth / 2, kHeight / 2));
}

TEST_F(LooksTest, AClearPaneIsSeenThrough) {
  MeshLook clear;
  clear.base_color = {0.8f, 0.9f, 0.92f};
  clear.opacity = 0.25f;
  clear.roughness = 0.05f;
  MeshLook grey;
  grey.base_color = glm::vec3(0.3f);
  grey.roughness = 1.0f;
  // A CPU draws only the side that faces the eye; else there are two panes.
  for (const int panes : {1, 2}) {
    SCOPED_TRACE(panes);
    RenderOptions options = small();
    options.draw_background = false;
    options.quality = panes == 1 ? Quality::kFast : Quality::kFull;
    auto renderer = make(options);
    Frame frame = frame_of({}, {}, 0.01f);
    const MeshInstance wall =
        place(*renderer, kit::make_box({-0.5f, -0.4f, -0.3f}, {0.5f, 0.4f, -0.2f}), grey);
    frame.meshes = {wall};
    renderer->draw(frame);
    const FloatImage bare = renderer->read_buffer(Buffer::kFinalColor);
    frame.meshes = {wall, place(*renderer, kit::make_box({-0.2f, -0.2f, 0.1f}, {0.2f, 0.2f, 0.11f}), clear)};
    renderer->draw(frame);
    const FloatImage behind = renderer->read_buffer(Buffer::kFinalColor);
    const int x = kWidth / 2;
    const int y = kHeight / 2;
    // Each tints by a quarter of its colour, less what two faces mirror: no haze of its own.
    const float mirrored = 2.0f * 0.04f / 1.04f;
    for (int c = 0; c < 3; ++c) {
      const float one = (0.75f + 0.25f * clear.base_color[c]) * (1.0f - mirrored);
      const float through = bare.at(x, y, c) * (panes == 1 ? one : one * one);
      EXPECT_GT(behind.at(x, y, c), through - 0.02f) << c;
      EXPECT_LT(behind.at(x, y, c), through + static_cast<float>(panes) * mirrored) << c;
    }
  }
}

/// A white board, its top at y = 0, and who says where it is.
std::optional<WallPoint> board_at(const glm::vec3& at, float reach) {
  if (std::abs(at.y) > reach) return std::nullopt;
  return WallPoint{{at.x, 0.0f, at.z}, {0.0f, 1.0f, 0.0f}};
}

/// A drop that lies on a board is flat, by either path.
class LyingDropTest : public LooksTest, public testing::WithParamInterface<PixelPasses> {};
INSTANTIATE_TEST_SUITE_P(Paths, LyingDropTest,
                         testing::Values(PixelPasses::kFragments, PixelPasses::kCompute),
                         [](const auto& path) {
                           return path.param == PixelPasses::kCompute ? "Compute" : "Fragments";
                         });

TEST_P(LyingDropTest, ADropOnABoardIsFlat) {
  RenderOptions options = small();
  options.width = 240;
  options.height = 240;
  options.shadow_size = 0;
  options.quality = Quality::kFast;
  options.pixel_passes = GetParam();
  auto renderer = make(options);
  constexpr float kRadius = 0.005f;
  const std::vector<glm::vec3> points{{0.0f, 1.2f * kRadius, 0.0f}};
  const std::vector<std::uint8_t> fluids{0};
  Frame frame = frame_of(points, fluids, kRadius);
  frame.meshes = {place(*renderer, kit::make_box({-0.2f, -0.02f, -0.2f}, {0.2f, 0.0f, 0.2f}),
                        {glm::vec3(0.5f), 0.0f, 1.0f, 1.0f})};
  frame.view = kit::make_view({0.0f, 0.1f, 1e-4f}, {0.0f, 0.0f, 0.0f}, options.width, options.height);
  // m² of the board that it covers, seen from above.
  const auto covered = [&] {
    renderer->draw(frame);
    const FloatImage fluid = renderer->read_buffer(Buffer::kFluidIndex);
    const double pixel = 2.0 * 0.1 / (frame.view.projection[1][1] * options.height);
    return pixel * pixel *
           static_cast<double>(std::ranges::count_if(fluid.values, [](float f) { return f >= 0.0f; }));
  };
  const double ball = covered();
  EXPECT_NEAR(ball / (M_PI * kRadius * kRadius), 1.26, 0.15) << "its outline is a pixel wider";
  frame.wall = board_at;
  const double lying = covered();
  EXPECT_NEAR(lying / (M_PI * kRadius * kRadius), 1.95 * 1.95, 0.5);
  // 0.53 radii, less what the surface's filter takes off a tip.
  const float depth = renderer->read_buffer(Buffer::kSmoothDepth).at(120, 120);
  EXPECT_NEAR((0.1f - depth) / kRadius, 0.4f, 0.15f);
}

TEST_F(LooksTest, AWetBoardIsDarkerWhereItIsWet) {
  RenderOptions options = small();
  options.environment = even_room();
  options.quality = Quality::kFast;
  options.antialias = false;
  // One that is wet is drawn by fragments, whatever draws the rest.
  for (const PixelPasses passes : {PixelPasses::kFragments, PixelPasses::kCompute}) {
    options.pixel_passes = passes;
    auto renderer = make(options);
    const glm::vec3 painted(0.2f, 0.5f, 0.8f);
    Frame frame;
    frame.meshes = {place(*renderer, kit::make_box({-0.2f, -0.02f, -0.2f}, {0.2f, 0.0f, 0.2f}),
                          {painted, 0.0f, 1.0f, 1.0f})};
    frame.view = kit::make_view({0.0f, 0.3f, 1e-4f}, {0.0f, 0.0f, 0.0f}, options.width, options.height);
    frame.light_direction = {-0.6f, -1.0f, 0.0f};
    renderer->draw(frame);
    const FloatImage dry = renderer->read_buffer(Buffer::kFinalColor);
    // The right half is wet, in cells of 2 cm, on a layer that has the top's faces 5 mm below its middle.
    std::vector<std::uint8_t> shares(20 * 3 * 20, 0);
    for (int z = 0; z < 20; ++z)
      for (int x = 10; x < 20; ++x) shares[static_cast<std::size_t>(x + 20 * (1 + 3 * z))] = 255;
    frame.meshes[0].wet = {
        1, {-0.2f, -0.025f, -0.2f}, 0.02f, 0.005f, {20, 3, 20}, shares, {10, 1, 0}, {20, 2, 20}};
    renderer->draw(frame);
    const FloatImage wet = renderer->read_buffer(Buffer::kFinalColor);
    const glm::vec3 left = shader::wet_share(painted);
    const int y = options.height / 2;
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(wet.at(options.width / 4, y, c), dry.at(options.width / 4, y, c));
      // 4 % are mirrored by either, and more light off the wet one.
      const float share = wet.at(3 * options.width / 5, y, c) / dry.at(3 * options.width / 5, y, c);
      EXPECT_NEAR(share, left[c], 0.08f) << c;
    }
    frame.meshes[0].wet = {};
    renderer->draw(frame);
    EXPECT_EQ(renderer->read_buffer(Buffer::kFinalColor).values, dry.values) << "dry again";
  }
}

TEST_F(LooksTest, AFullVesselsRimStaysAtItsWall) {
  // A corner of deep water: few are near there, too, but no film.
  shader::Neighbourhood corner{8.0f, glm::vec3(8.0f * 0.005f), glm::vec3(1e-3f), glm::vec3(0.0f)};
  shader::Neighbourhood film{8.0f, glm::vec3(0.0f), glm::vec3(1e-3f, 0.0f, 1e-3f), glm::vec3(0.0f)};
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  const auto lying_share = [](const shader::Neighbourhood& n, const glm::vec3& normal, float away,
                              float radius) {
    return shader::lying_share(n.weights, shader::neighbours_mean(n), normal, away, radius);
  };
  EXPECT_EQ(lying_share(corner, up, 0.005f, 0.005f), 0.0f);
  EXPECT_EQ(lying_share(film, up, 0.005f, 0.005f), 1.0f);
  EXPECT_EQ(lying_share(film, up, 0.012f, 0.005f), 0.0f) << "it falls still";
  film.weights = 16.0f;
  EXPECT_EQ(lying_share(film, up, 0.005f, 0.005f), 0.0f) << "several layers";
  const glm::mat3 lying = shader::lying_ellipsoid(1.0f, up, 0.005f);
  const float volume = 0.5f * std::sqrt(glm::determinant(lying));
  EXPECT_NEAR(volume / std::pow(0.005f, 3.0f), 1.0f, 0.02f);
}

}  // namespace
}  // namespace slosh
