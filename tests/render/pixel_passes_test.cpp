// Passes over pixels and splats as compute shaders: the same picture as by fragments, to rounding.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/render/render_test.h"

namespace slosh {
namespace {

using PixelPassesTest = RenderTest;

struct Drawn {
  FloatImage front;
  FloatImage back;
  FloatImage surface;
  FloatImage thickness;
  Image picture;
};

/// `fill`: makes the scene's fluid what it is to be.
template <class Fill>
Drawn draw(Context& context, RenderOptions options, PixelPasses way, int particles, Fill&& fill) {
  options.pixel_passes = way;
  auto made = Renderer::create(context, options);
  EXPECT_TRUE(made) << made.error().text();
  Renderer& renderer = *made.value();
  EXPECT_EQ(renderer.on_compute(), way == PixelPasses::kCompute);
  kit::DamBreak scene(renderer, particles, options.width, options.height);
  fill(scene);
  renderer.draw(scene.frame);
  return {renderer.read_buffer(Buffer::kFrontDepth), renderer.read_buffer(Buffer::kBackDepth),
          renderer.read_buffer(Buffer::kSmoothDepth), renderer.read_buffer(Buffer::kThickness),
          renderer.read_back()};
}

Drawn draw(Context& context, const RenderOptions& options, PixelPasses way) {
  return draw(context, options, way, 2500, [](kit::DamBreak& scene) {
    scene.frame.fluids.push_back(kit::cloudy_juice());
    for (std::size_t i = 0; i < scene.fluids.size() / 2; ++i) scene.fluids[i] = 1;
  });
}

/// Share of values that are farther apart than `apart`.
double share_off(const FloatImage& a, const FloatImage& b, float apart) {
  EXPECT_EQ(a.values.size(), b.values.size());
  std::size_t off = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    off += std::abs(a.values[i] - b.values[i]) > apart ? 1 : 0;
  return static_cast<double>(off) / static_cast<double>(a.values.size());
}

/// Chords are summed in whole numbers, not in half floats, and panes of glass are laid over each other before
/// they are rounded to half floats, not after each: a step of eight bits here and there. A pixel on the very
/// edge of a triangle may be its or not.
void expect_same(const Image& a, const Image& b) {
  ASSERT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0.0;
  std::size_t off = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const int apart = std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    sum += apart;
    off += apart > 2 ? 1 : 0;
  }
  const auto channels = static_cast<double>(a.rgba.size());
  EXPECT_LT(sum / channels, 0.018);
  EXPECT_LT(static_cast<double>(off) / channels, 4e-4);
}

/// Shares of pixels that may be apart.
struct Apart {
  double front;
  double back;
  double surface;
  double thickness;
};
/// A pixel on the very rim of a splat may be its or not.
constexpr Apart kBySoftware{1e-4, 1e-4, 1e-4, 3e-3};
/// A chip has a triangle's corners on 256ths of a pixel, and a splat's disc with them, which shows near its rim,
/// where depths fall off steeply: with the corners put there compute shaders differ from an H200's fragments in no
/// pixel of the front and one in 7000 of the back. All of what thickness differs by is the sum of chords (without
/// it: none), in half floats there, in whole numbers here.
constexpr Apart kByChip{6e-3, 2.6e-2, 2e-3, 7e-2};

void expect_same(const RenderOptions& options, Context& context) {
  const Apart& most = context.is_software() ? kBySoftware : kByChip;
  const Drawn by_fragments = draw(context, options, PixelPasses::kFragments);
  const Drawn by_compute = draw(context, options, PixelPasses::kCompute);
  EXPECT_LT(share_off(by_fragments.front, by_compute.front, 2e-5f), most.front);
  EXPECT_LT(share_off(by_fragments.back, by_compute.back, 2e-5f), most.back);
  EXPECT_LT(share_off(by_fragments.surface, by_compute.surface, 2e-5f), most.surface);
  EXPECT_LT(share_off(by_fragments.thickness, by_compute.thickness, 5e-4f), most.thickness);
  expect_same(by_fragments.picture, by_compute.picture);
}

TEST_F(PixelPassesTest, EverySurfaceIsTheSameByComputeShadersAtFullQuality) {
  for (const Surface surface : {Surface::kOurs, Surface::kCurvatureFlow, Surface::kPaper}) {
    SCOPED_TRACE(static_cast<int>(surface));
    RenderOptions options = small();
    if (surface == Surface::kPaper) options = section_five(options);
    options.surface = surface;
    options.quality = Quality::kFull;
    expect_same(options, *context_);
  }
}

TEST_F(PixelPassesTest, AndWhereTheQuickWaysOfAProcessorAreTaken) {
  RenderOptions options = small();
  options.quality = Quality::kFast;
  options.width = 189;  // no whole number of groups
  options.height = 131;
  expect_same(options, *context_);
}

TEST_F(PixelPassesTest, OfManyParticlesWhatIsDeepInTheFluidIsNotMissed) {
  RenderOptions options = small();
  options.quality = Quality::kFull;
  for (const int many : {12000, 105000}) {  // the second time by short rows, too
    SCOPED_TRACE(many);
    const Drawn seen = draw(*context_, options, PixelPasses::kCompute, many, [](kit::DamBreak&) {});
    // Where there may be several fluids all of it is drawn.
    const Drawn all = draw(*context_, options, PixelPasses::kCompute, many, [](kit::DamBreak& scene) {
      scene.frame.fluids.push_back(kit::cloudy_juice());
    });
    EXPECT_EQ(seen.front.values, all.front.values);
    EXPECT_EQ(seen.back.values, all.back.values);
    EXPECT_EQ(seen.surface.values, all.surface.values);
    EXPECT_EQ(seen.thickness.values, all.thickness.values);
  }
}

TEST_F(PixelPassesTest, SumsComeOutTheSameEachTime) {
  RenderOptions options = small();
  options.quality = Quality::kFull;
  const Drawn once = draw(*context_, options, PixelPasses::kCompute);
  const Drawn again = draw(*context_, options, PixelPasses::kCompute);
  EXPECT_EQ(once.picture.rgba, again.picture.rgba);
}

TEST_F(PixelPassesTest, WhatIsMeasuredIsKeptAndMayBeChangedLater) {
  RenderOptions options = small();
  auto first = make(options);
  const bool on_compute = first->on_compute();
  EXPECT_EQ(make(options)->on_compute(), on_compute);
  options.pixel_passes = on_compute ? PixelPasses::kFragments : PixelPasses::kCompute;
  ASSERT_TRUE(first->set_options(options));
  EXPECT_NE(first->on_compute(), on_compute);
  kit::DamBreak scene(*first, 500, kWidth, kHeight);
  first->draw(scene.frame);
  EXPECT_FALSE(first->read_back().rgba.empty());
}

}  // namespace
}  // namespace slosh
