// Passes over pixels and splats as compute shaders: the same picture as by fragments, to rounding.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

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
  options.bridges = false;  // fragments' alone
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

/// What pictures may differ by: the mean of a channel in 255ths, and the share of channels by more than two.
struct PictureApart {
  double mean;
  double share;
};
/// Panes of glass are laid over each other before they are rounded to half floats, not after each: a step of
/// eight bits here and there. A pixel on the very edge of a triangle may be its or not. A drop is a lens that
/// bends light the more the steeper it is: 0.0222, and 7.8e-4 of the channels.
constexpr PictureApart kPictures{0.024, 8.5e-4};

void expect_same(const Image& a, const Image& b, const PictureApart& most) {
  ASSERT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0.0;
  std::size_t off = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const int apart = std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    sum += apart;
    off += apart > 2 ? 1 : 0;
  }
  const auto channels = static_cast<double>(a.rgba.size());
  EXPECT_LT(sum / channels, most.mean);
  EXPECT_LT(static_cast<double>(off) / channels, most.share);
}

/// Shares of pixels that may be apart, and what pictures may be.
struct Apart {
  double front;
  double back;
  double surface;
  double thickness;
  PictureApart picture;
};
/// A pixel on the very rim of a splat may be its or not. Thickness is by the sum of chords, in half floats or
/// in whole numbers, but where the surface is nearer to the back: by the quick ways that is so in 76 of 24
/// 759 pixels that are half a millimetre apart.
constexpr Apart kBySoftware{1e-4, 1e-4, 1e-4, 3.5e-3, kPictures};
/// A chip puts corners on 256ths of a pixel; splat.vert puts them there first, so that disc and corners
/// agree. All of what thickness differs by is the sum of chords, in half floats there, in whole numbers here,
/// and so is most of what the pictures do.
constexpr Apart kByChip{3e-4, 6e-4, 3e-4, 7e-2, {0.1, 6.5e-3}};
/// Without the sum of chords (RenderOptions::layers).
constexpr Apart kByChipWithoutChords{3e-4, 6e-4, 3e-4, 1.5e-3, kPictures};

void expect_same(const RenderOptions& options, Context& context, const Apart& most) {
  const Drawn by_fragments = draw(context, options, PixelPasses::kFragments);
  const Drawn by_compute = draw(context, options, PixelPasses::kCompute);
  EXPECT_LT(share_off(by_fragments.front, by_compute.front, 2e-5f), most.front);
  EXPECT_LT(share_off(by_fragments.back, by_compute.back, 2e-5f), most.back);
  EXPECT_LT(share_off(by_fragments.surface, by_compute.surface, 2e-5f), most.surface);
  EXPECT_LT(share_off(by_fragments.thickness, by_compute.thickness, 5e-4f), most.thickness);
  expect_same(by_fragments.picture, by_compute.picture, most.picture);
}

void expect_same(RenderOptions options, Context& context) {
  expect_same(options, context, context.is_software() ? kBySoftware : kByChip);
  if (context.is_software()) return;
  options.layers = false;
  expect_same(options, context, kByChipWithoutChords);
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

// But for our filter, which on a processor takes fewer taps then.
TEST_F(PixelPassesTest, AndAtFastQuality) {
  RenderOptions options = small();
  options.quality = Quality::kFast;
  options.surface = Surface::kCurvatureFlow;
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
    const Drawn all = draw(*context_, options, PixelPasses::kCompute, many,
                           [](kit::DamBreak& scene) { scene.frame.fluids.push_back(kit::cloudy_juice()); });
    EXPECT_EQ(seen.front.values, all.front.values);
    EXPECT_EQ(seen.back.values, all.back.values);
    EXPECT_EQ(seen.surface.values, all.surface.values);
    EXPECT_EQ(seen.thickness.values, all.thickness.values);
  }
}

// Foam lies between the fluid and the panes before it.
TEST_F(PixelPassesTest, PanesBeforeTheFluidAreLaidOverItAndOverFoam) {
  static const std::vector<FoamPoint> kFoam = {{{0.0f, 0.1f, 0.05f}, 0.004f}};
  RenderOptions options = small();
  options.quality = Quality::kFull;
  const auto fill = [](kit::DamBreak& scene) {
    scene.frame.meshes.back().look.base_color = {0.4f, 0.8f, 0.5f};  // of the tank: tinted
    scene.frame.meshes.back().look.opacity = 0.4f;
    scene.frame.meshes.back().look.roughness = 0.35f;
    scene.frame.foam = kFoam;
  };
  const Drawn by_fragments = draw(*context_, options, PixelPasses::kFragments, 2500, fill);
  const Drawn by_compute = draw(*context_, options, PixelPasses::kCompute, 2500, fill);
  expect_same(by_fragments.picture, by_compute.picture,
              context_->is_software() ? kPictures : kByChip.picture);
}

// Cells that share an entry of the table: their particles have each their own neighbours.
TEST_F(PixelPassesTest, ParticlesFarApartAreSmoothedByTheirOwnNeighbours) {
  RenderOptions options = small();
  options.quality = Quality::kFull;
  for (const int many : {3000, 12000}) {  // all are smoothed; those that are not deep
    SCOPED_TRACE(many);
    const auto spread = [](kit::DamBreak& scene) {
      const float radius = scene.frame.particle_radius;
      for (std::size_t i = 0; i < scene.particles.size(); ++i) {
        glm::vec3& at = scene.particles[i];
        at = i % 6 == 0 ? at + 6.0f * (at - glm::vec3(0.0f, 0.1f, 0.0f))
                        : scene.particles[i - 1] + glm::vec3(0.9f, 0.5f, -0.4f) * radius;
      }
    };
    const Drawn by_fragments = draw(*context_, options, PixelPasses::kFragments, many, spread);
    const Drawn by_compute = draw(*context_, options, PixelPasses::kCompute, many, spread);
    const Apart& most = context_->is_software() ? kBySoftware : kByChip;
    EXPECT_LT(share_off(by_fragments.front, by_compute.front, 2e-5f), most.front);
    EXPECT_LT(share_off(by_fragments.back, by_compute.back, 2e-5f), most.back);
  }
}

TEST_F(PixelPassesTest, OfSoManyThatGroupsGoOnTwoAxesEachIsAddedOnce) {
  RenderOptions options = small();
  options.quality = Quality::kFull;
  options.shadow_size = 0;
  options.bilateral_iterations = 0;
  options.surface = Surface::kCurvatureFlow;  // particles are not moved
  // 32 768 groups of sixteen rows are on the first axis. One in a hundred is drawn.
  const auto leave_few = [](kit::DamBreak& scene) {
    for (std::size_t i = 0; i < scene.fluids.size(); ++i) scene.fluids[i] = i % 101 == 0 ? 0 : 255;
    scene.frame.particle_radius = 0.003f;
  };
  const Drawn by_fragments = draw(*context_, options, PixelPasses::kFragments, 480000, leave_few);
  const Drawn by_compute = draw(*context_, options, PixelPasses::kCompute, 480000, leave_few);
  const auto sum = [](const FloatImage& image) {
    return std::accumulate(image.values.begin(), image.values.end(), 0.0);
  };
  // A chip's half floats lose one in a hundred.
  EXPECT_NEAR(sum(by_compute.thickness) / sum(by_fragments.thickness), 1.0,
              context_->is_software() ? 2e-3 : 2e-2);
}

TEST_F(PixelPassesTest, ParticlesOnAGpuThatDoesNotDrawHereAreSaidAndDrawnAllTheSame) {
  for (const PixelPasses way : {PixelPasses::kCompute, PixelPasses::kFragments}) {
    RenderOptions options = small();
    options.quality = Quality::kFull;
    options.pixel_passes = way;
    auto renderer = make(options);
    kit::DamBreak scene(*renderer, 500, kWidth, kHeight);
    renderer->draw(scene.frame);
    const Image without = renderer->read_back();
    EXPECT_EQ(renderer->particles_refused(), "");
    SharedParticles elsewhere;
    elsewhere.allocation = 7;
    elsewhere.bytes = 1 << 20;
    elsewhere.count = scene.particles.size();
    elsewhere.fluids = 1 << 19;
    scene.frame.on_gpu = std::make_shared<const SharedParticles>(elsewhere);
    renderer->draw(scene.frame);
    EXPECT_EQ(renderer->read_back().rgba, without.rgba);
    EXPECT_FALSE(renderer->reads_particles_on_gpu());
    EXPECT_NE(renderer->particles_refused().find("main memory"), std::string::npos)
        << renderer->particles_refused();
  }
}

TEST_F(PixelPassesTest, SumsComeOutTheSameEachTime) {
  RenderOptions options = small();
  options.quality = Quality::kFull;
  const Drawn once = draw(*context_, options, PixelPasses::kCompute);
  const Drawn again = draw(*context_, options, PixelPasses::kCompute);
  EXPECT_EQ(once.picture.rgba, again.picture.rgba);
}

TEST_F(PixelPassesTest, AGpuDrawsByComputeShadersAndThatMayBeChangedLater) {
  RenderOptions options = small();
  auto first = make(options);
  const bool on_compute = first->on_compute();
  EXPECT_EQ(on_compute, !context_->is_software());
  options.pixel_passes = on_compute ? PixelPasses::kFragments : PixelPasses::kCompute;
  ASSERT_TRUE(first->set_options(options));
  EXPECT_NE(first->on_compute(), on_compute);
  kit::DamBreak scene(*first, 500, kWidth, kHeight);
  first->draw(scene.frame);
  EXPECT_FALSE(first->read_back().rgba.empty());
}

}  // namespace
}  // namespace slosh
