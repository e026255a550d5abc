// The surface against a pool of which depths and normals are known, and the filters' maths.
#include "tests/lab/picture/score/score.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "render/passes/narrow_range_on_cpu.h"
#include "render/passes/smooth_centers.h"
#include "render/shader_math.h"
#include "tests/lab/picture/score/shape.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

class ScoreTest : public RenderTest {
 protected:
  static constexpr int kPoolWidth = 640;
  static constexpr int kPoolHeight = 360;

  static score::SurfaceScore score_of(const score::Pool& pool, const score::Exact& exact, Surface surface,
                                      Quality quality) {
    RenderOptions options;
    if (surface == Surface::kPaper) options = section_five(options);
    options.surface = surface;
    options.width = kPoolWidth;
    options.height = kPoolHeight;
    options.quality = quality;
    auto renderer = make(options);
    const Frame frame = pool.frame();
    renderer->draw(frame);
    return score::score_surface(renderer->read_buffer(Buffer::kSmoothDepth),
                                renderer->read_buffer(Buffer::kNormal), exact, frame.particle_radius,
                                3.0f * frame.particle_radius);
  }
};

// As measured (llvmpipe): paper 22°, flow 18°, ours 2.4° at 5 pixels of radius, with a GPU's taps too.
TEST_F(ScoreTest, NormalsOfAnAnalyticPool) {
  const score::Pool pool = score::make_pool(5.0f, kPoolWidth, kPoolHeight);
  const score::Exact exact = score::exact_pool(pool, kPoolWidth, kPoolHeight);
  const score::SurfaceScore paper = score_of(pool, exact, Surface::kPaper, Quality::kFast);
  const score::SurfaceScore flow = score_of(pool, exact, Surface::kCurvatureFlow, Quality::kFast);
  EXPECT_GT(paper.pixels, 100000u);
  EXPECT_GT(paper.normal_mean, 15.0) << "spheres are seen: the pool can tell filters apart";
  EXPECT_LT(flow.normal_mean, 0.9 * paper.normal_mean);
  for (const Quality quality : {Quality::kFast, Quality::kFull}) {
    const score::SurfaceScore ours = score_of(pool, exact, Surface::kOurs, quality);
    EXPECT_LT(ours.normal_mean, 3.0);
    EXPECT_LT(ours.normal_p95, 7.0);
    EXPECT_LT(ours.edge_mean, 10.0);
    EXPECT_LT(std::abs(ours.depth_bias), 0.15)
        << "particle radii: smoothing must not shrink the fluid, nor swell it";
    EXPECT_LT(ours.depth_rms, 0.4);
    EXPECT_LT(ours.silhouette, 2.2) << "px, of particles of 5 px radius";
  }
}

// Taps far apart leave a net of lines in large particles' surface, and a filter that takes what is beyond the
// picture for flat bends its rim. As measured 6.9° and 16.0° (p95); with such a net 7.3° and 18.0°, with a
// bent rim too 7.6° and 20.2°.
TEST_F(ScoreTest, LargeParticlesShowNoNetAndThePictureNoRim) {
  const score::Pool pool = score::make_pool(15.0f, kPoolWidth, kPoolHeight);
  const score::Exact exact = score::exact_pool(pool, kPoolWidth, kPoolHeight);
  for (const Quality quality : {Quality::kFast, Quality::kFull}) {
    const score::SurfaceScore ours = score_of(pool, exact, Surface::kOurs, quality);
    EXPECT_LT(ours.normal_mean, 7.1);
    EXPECT_LT(ours.normal_p95, 17.0);
  }
}

TEST_F(ScoreTest, TheExactPictureScoresNought) {
  const score::Pool pool = score::make_pool(20.0f, kPoolWidth, kPoolHeight);
  const score::Exact exact = score::exact_pool(pool, kPoolWidth, kPoolHeight);
  const score::SurfaceScore same = score::score_surface(exact.depth, exact.normal, exact, 0.01f, 0.03f);
  EXPECT_GT(same.pixels, 100000u);
  EXPECT_LT(same.normal_mean, 0.05);
  EXPECT_EQ(same.depth_bias, 0.0);
  EXPECT_EQ(same.silhouette, 0.0);
  // The exact normals are those of the exact depths.
  FloatImage turned = exact.normal;
  for (std::size_t i = 0; i < turned.values.size(); i += 3) {
    const glm::vec3 n(turned.values[i], turned.values[i + 1], turned.values[i + 2]);
    const glm::vec3 t =
        glm::vec3(glm::rotate(glm::mat4(1.0f), 0.2f, glm::vec3(0, 0, 1)) * glm::vec4(n, 0.0f));
    for (int c = 0; c < 3; ++c) turned.values[i + static_cast<std::size_t>(c)] = t[c];
  }
  const score::SurfaceScore off = score::score_surface(exact.depth, turned, exact, 0.01f, 0.03f);
  EXPECT_GT(off.normal_mean, 4.0);
  EXPECT_LT(off.normal_mean, 11.46) << "0.2 rad about the view, so less for normals that face the eye";
}

/// Discs of fluid that face the eye, each x, y and radius in pixels.
score::Exact discs(const std::vector<glm::vec3>& all) {
  constexpr int kSide = 100;
  score::Exact exact = score::nothing_seen(kSide, kSide);
  for (int i = 0; i < kSide * kSide; ++i) {
    for (const glm::vec3& disc : all) {
      if (glm::distance(glm::vec2(i % kSide, i / kSide), glm::vec2(disc)) > disc.z) continue;
      exact.depth.values[static_cast<std::size_t>(i)] = 1.0f;
      exact.normal.values[static_cast<std::size_t>(3 * i + 2)] = 1.0f;
    }
  }
  return exact;
}

TEST(Shape, OfDiscsIsKnown) {
  const score::Exact right = discs({{25, 50, 20}, {75, 50, 20}});
  const score::ShapeScore same = score::score_shape(right, right);
  EXPECT_EQ(same.overlap, 1.0);
  EXPECT_EQ(same.area, 1.0);
  EXPECT_EQ(same.pieces, 2);
  EXPECT_EQ(same.right_pieces, 2);
  EXPECT_LT(same.normal_mean, 0.1);
  // The one is in the other, which has twice its area.
  const float wider = 20.0f * std::sqrt(2.0f);
  const score::ShapeScore one =
      score::score_shape(discs({{50, 50, wider}}), discs({{50, 50, 20}, {5, 5, 1}}));
  EXPECT_NEAR(one.overlap, 0.5, 0.02);
  EXPECT_NEAR(one.area, 2.0, 0.02);
  EXPECT_EQ(one.pieces, 1);
  EXPECT_EQ(one.right_pieces, 1) << "five pixels are no piece";
  const score::ShapeScore none = score::score_shape(discs({}), right);
  EXPECT_EQ(none.overlap, 0.0);
  EXPECT_EQ(none.pieces, 0);
}

TEST(Flicker, IsTheMeanChangeOfAChannel) {
  Image a{2, 1, std::vector<std::uint8_t>(8, 100)};
  Image b = a;
  EXPECT_EQ(score::flicker(a, b), 0.0);
  b.rgba = {106, 100, 100, 0, 100, 100, 100, 100};
  EXPECT_DOUBLE_EQ(score::flicker(a, b), 1.0);
}

TEST(StirScore, WhatChangesEvenlyIsNotRestless) {
  const auto gray = [](float shown) {  // of 255, as sRGB
    const float v = shown / 255.0f;
    const float light = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
    return FloatImage{2, 1, 3, {light, light, light, 0.3f, 0.3f, 0.3f}};
  };
  const FloatImage left_is_fluid{2, 1, 1, {0.0f, -1.0f}};
  const std::array<FloatImage, 3> index{left_is_fluid, left_is_fluid, left_is_fluid};
  const score::StirScore even = score::score_stir({gray(100), gray(104), gray(108)}, index);
  EXPECT_EQ(even.pixels, 1u);
  EXPECT_NEAR(even.change, 4.0, 1e-3);
  EXPECT_NEAR(even.restless, 0.0, 1e-3);
  const score::StirScore flickers = score::score_stir({gray(100), gray(104), gray(100)}, index);
  EXPECT_NEAR(flickers.change, 4.0, 1e-3);
  EXPECT_NEAR(flickers.restless, 4.0, 1e-3);
  FloatImage bare = left_is_fluid;
  bare.values[0] = -1.0f;
  EXPECT_EQ(score::score_stir({gray(100), gray(104), gray(108)}, {bare, left_is_fluid, bare}).pixels, 0u);
}

TEST(NarrowRange, ASlopeStaysOneSurfaceAndAStepDoesNot) {
  using namespace shader;
  DepthRange range = narrow_range(1.0f, 0.1f);
  for (int i = 1; i < 20; ++i) {
    const float depth = 1.0f + 0.05f * static_cast<float>(i);
    ASSERT_TRUE(in_range(range, depth)) << i;
    range = widened(range, depth, 0.1f);
  }
  EXPECT_FALSE(in_range(range, 0.85f)) << "it widens only where the surface went";
  EXPECT_FALSE(in_range(narrow_range(1.0f, 0.1f), 1.11f));
  EXPECT_FLOAT_EQ(kernel_weight(0.0f), 1.0f);
  EXPECT_FLOAT_EQ(kernel_weight(1.0f), 0.0f);
}

TEST_F(ScoreTest, TheFilterInMainMemoryIsTheShaders) {
  RenderOptions options = small();
  options.quality = Quality::kFull;
  options.pixel_passes = PixelPasses::kCompute;
  const auto renderer = make(options);
  const kit::DamBreak scene(*renderer, 1500, kWidth, kHeight);
  renderer->draw(scene.frame);
  const FloatImage front = renderer->read_buffer(Buffer::kFrontDepth);
  const FloatImage bodies = renderer->read_buffer(Buffer::kSceneDepth);
  const FloatImage shader = renderer->read_buffer(Buffer::kSmoothDepth);
  const float radius = options.splat_scale * scene.frame.particle_radius;
  NarrowRangeOnCpu filter;
  const std::span<const float> smooth = filter.run(
      front.values, bodies.values, {kWidth, kHeight},
      {3.8f * radius, 5.0f * radius, 20, 20, 0.5f * scene.frame.view.projection[1][1] * kHeight, radius});
  int fluid = 0;
  int moved = 0;
  for (std::size_t i = 0; i < front.values.size(); ++i) {
    if (front.values[i] >= kNoFluidDepth) {
      EXPECT_EQ(smooth[i], front.values[i]);
      continue;
    }
    ++fluid;
    moved += std::abs(smooth[i] - front.values[i]) > 1e-4f ? 1 : 0;
    // Order of sums; where a depth lies at the range's very end one of them may count it and the other not.
    EXPECT_NEAR(smooth[i], shader.values[i], 2e-4f) << i;
  }
  EXPECT_GT(fluid, 1000);
  EXPECT_GT(moved, fluid / 2);
}

TEST(PictureScore, TellsFluidItsEdgesAndTheRestApart) {
  constexpr int kSide = 60;
  FloatImage depth{kSide, kSide, 1, std::vector<float>(kSide * kSide, kNoFluidDepth)};
  Image right{kSide, kSide, std::vector<std::uint8_t>(4 * kSide * kSide, 100)};
  Image drawn = right;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * kSide + x;
      if (x >= 30) depth.values[i] = 1.0f;
      const int off = x >= 45 ? 6 : x < 15 ? 90 : 0;  // well inside, and far from the fluid
      for (std::size_t c = 0; c < 3; ++c) drawn.rgba[4 * i + c] = static_cast<std::uint8_t>(100 + off);
    }
  }
  const score::PictureScore inside = score::score_picture(drawn, right, depth, 0.05f);
  EXPECT_EQ(inside.edges, 0.0);
  EXPECT_GT(inside.edge_pixels, std::size_t{kSide * 2 * score::kEdgeBand});
  EXPECT_NEAR(inside.inside, 6.0 * 15 / (30 - score::kEdgeBand), 0.5);
  for (int y = 0; y < kSide; ++y) drawn.rgba[4 * (static_cast<std::size_t>(y) * kSide + 29)] = 130;
  EXPECT_GT(score::score_picture(drawn, right, depth, 0.05f).edges, 0.4)
      << "what is drawn beside the fluid counts";
}

Frame frame_of_points(const std::vector<glm::vec3>& points, const std::vector<std::uint8_t>& fluids,
                      float radius) {
  Frame frame;
  frame.view = kit::make_view({0.0f, 0.0f, 1.0f}, glm::vec3(0.0f), 100, 100);
  frame.particles = points;
  frame.particle_fluid = fluids;
  frame.fluids = {kit::water()};
  frame.particle_radius = radius;
  return frame;
}

TEST(SmoothCenters, AFlatSurfaceStaysItsNoiseGoesAndADropStays) {
  const float spacing = 0.02f;
  auto points = kit::jitter_lattice({-0.2f, -0.2f, -0.12f}, {0.2f, 0.2f, 0.0f}, spacing, 5);
  kit::relax(points, spacing, {-0.2f, -0.2f, -0.12f}, {0.2f, 0.2f, 0.0f}, 8);
  points.emplace_back(0.0f, 0.0f, 0.3f);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  const Frame frame = frame_of_points(points, fluids, 0.62f * spacing);
  Splats splats;
  std::vector<glm::vec4>& spheres = splats.spheres;
  for (const glm::vec3& p : points) {
    splats.particles.push_back(static_cast<std::uint32_t>(spheres.size()));
    spheres.emplace_back(glm::vec3(frame.view.view * glm::vec4(p, 1.0f)), 3.0f);
  }
  SmoothCenters centers;
  centers.sort(frame);
  centers.move(frame, splats);
  // Of the particles of the upper layer, away from the sides.
  double before = 0.0, after = 0.0, before2 = 0.0, after2 = 0.0;
  int count = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    EXPECT_EQ(spheres[i].w, 3.0f);
    const glm::vec3& p = points[i];
    if (p.z < -0.7f * spacing || std::max(std::abs(p.x), std::abs(p.y)) > 0.14f) continue;
    const double moved = 1.0 + spheres[i].z;  // the eye is at z = 1
    before += p.z;
    before2 += double{p.z} * p.z;
    after += moved;
    after2 += moved * moved;
    ++count;
  }
  ASSERT_GT(count, 100);
  const double mean_before = before / count, mean_after = after / count;
  EXPECT_NEAR(mean_after, mean_before, 0.35 * spacing) << "the surface stays";
  EXPECT_LT(after2 / count - mean_after * mean_after, 0.5 * (before2 / count - mean_before * mean_before));
  EXPECT_NEAR(spheres.back().z, 0.3f - 1.0f, 1e-5f) << "a particle alone stays";
  EXPECT_NEAR(splats.shapes.back().depth_radius, frame.particle_radius, 1e-6f)
      << "and is the ball of its volume";
  // On the flat surface ellipsoids lie flat in it.
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const glm::vec3& p = points[i];
    if (p.z < -0.2f * spacing || std::max(std::abs(p.x), std::abs(p.y)) > 0.12f) continue;
    EXPECT_LT(splats.shapes[i].depth_radius, 0.7f * splats.shapes[i].outline.x);
    EXPECT_GT(splats.shapes[i].outline.x, 1.3f * frame.particle_radius);
  }
}

/// Every particle of the frame as a splat, where it is.
Splats splats_of(const Frame& frame) {
  Splats splats;
  for (const glm::vec3& p : frame.particles) {
    splats.particles.push_back(static_cast<std::uint32_t>(splats.spheres.size()));
    splats.spheres.emplace_back(glm::vec3(frame.view.view * glm::vec4(p, 1.0f)), 0.0f);
  }
  return splats;
}

TEST(SmoothCenters, OnlyNeighboursCountHoweverFarOthersFlew) {
  const float spacing = 0.02f;
  auto points = kit::jitter_lattice({-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f}, spacing, 7);
  const std::size_t near = points.size();
  const std::vector<std::uint8_t> all_fluid(near, 0);
  const Frame alone = frame_of_points(points, all_fluid, 0.62f * spacing);
  // Two drops of a pair each, so far off that no table of cells reaches them; one that is lost; another's.
  for (const glm::vec3 far : {glm::vec3(4e3f, -2e3f, 50.0f), glm::vec3(-9e6f, 0.0f, 0.0f)}) {
    points.push_back(far);
    points.push_back(far + glm::vec3(0.5f * spacing, 0.0f, 0.0f));
  }
  points.emplace_back(NAN, 0.0f, 0.0f);
  points.emplace_back(0.001f, 0.0f, 0.0f);
  std::vector<std::uint8_t> fluids(points.size(), 0);
  fluids.back() = 9;
  const Frame frame = frame_of_points(points, fluids, 0.62f * spacing);

  Splats expected = splats_of(alone);
  SmoothCenters one;
  one.sort(alone);
  one.move(alone, expected);
  Splats splats = splats_of(frame);
  SmoothCenters centers;
  centers.sort(frame);
  centers.move(frame, splats);
  for (std::size_t i = 0; i < near; ++i) {
    ASSERT_LT(glm::distance(splats.spheres[i], expected.spheres[i]), 1e-6f) << i;
    ASSERT_NEAR(splats.shapes[i].depth_radius, expected.shapes[i].depth_radius, 1e-6f) << i;
  }
  // The first pair meets in the middle, nearly.
  const glm::vec3 apart(splats.spheres[near + 1] - splats.spheres[near]);
  EXPECT_LT(glm::length(apart), 0.4f * spacing);
}

}  // namespace
}  // namespace slosh
