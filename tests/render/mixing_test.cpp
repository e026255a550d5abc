// Where fluids meet: their looks go over into each other softly, and only there.
#include <algorithm>
#include <cmath>

#include "render/shader_math.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

using MixingTest = RenderTest;
constexpr float kSpacing = 0.02f;
constexpr float kRadius = 0.62f * kSpacing;
/// Of passes/mixing_pass.cpp, particle radii.
constexpr float kReach = 3.6f;

FluidLook opaque(const glm::vec3& color) {
  FluidLook look;
  look.color = color;
  look.extinction = glm::vec3(1e4f);
  look.scattering = 1.0f;
  look.gloss = 0.0f;
  return look;
}

/// A slab that faces the eye, red left of x = 0 and green right of it.
struct TwoFluids {
  std::vector<glm::vec3> points;
  std::vector<std::uint8_t> fluids;

  TwoFluids() {
    const glm::vec3 low(-0.7f, -0.5f, -0.08f);
    const glm::vec3 high(0.7f, 0.5f, 0.0f);
    points = kit::jitter_lattice(low, high, kSpacing, 3);
    kit::relax(points, kSpacing, low, high, 8);
    for (const glm::vec3& p : points) fluids.push_back(p.x < 0.0f ? 1 : 0);
  }
  Frame frame(int width, int height) const {
    Frame frame;
    frame.view = kit::make_view({0.0f, 0.0f, 1.0f}, glm::vec3(0.0f), width, height);
    frame.light_direction = {0.0f, 0.0f, -1.0f};
    frame.particles = points;
    frame.particle_fluid = fluids;
    frame.fluids = {opaque({0.0f, 1.0f, 0.0f}), opaque({1.0f, 0.0f, 0.0f})};
    frame.particle_radius = kRadius;
    return frame;
  }
};

/// Share of red at `x` m right of the boundary: of a fluid that fills z < 0, looked at in its surface, by the
/// kernel of mixing.glsl.
double exact_share(double x) {
  const double reach = kReach * kRadius;
  double red = 0.0;
  double all = 0.0;
  constexpr int kSteps = 120;
  for (int i = 0; i < kSteps; ++i) {
    // A slice of the kernel's half ball across x; of its disc the kernel's mean is known.
    const double off = reach * (-1.0 + 2.0 * (i + 0.5) / kSteps);
    const double left = 1.0 - off * off / (reach * reach);
    const double slice = left * left * left;  // ∫ (left − s)² ds over s = ρ²/reach², up to a factor
    all += slice;
    if (x + off < 0.0) red += slice;
  }
  return red / all;
}

TEST_F(MixingTest, ABoundaryIsAsWideAsItsKernel) {
  const TwoFluids two;
  const Frame frame = two.frame(kWidth, kHeight);
  for (const Quality quality : {Quality::kFast, Quality::kFull}) {
    SCOPED_TRACE(static_cast<int>(quality));
    RenderOptions options = small();
    options.quality = quality;
    auto renderer = make(options);
    renderer->draw(frame);
    const FloatImage light = renderer->read_buffer(Buffer::kFinalColor);
    const FloatImage depth = renderer->read_buffer(Buffer::kSmoothDepth);
    double worst = 0.0;
    int between = 0;
    for (int x = 30; x < kWidth - 30; ++x) {
      double red = 0.0;
      double away = 0.0;
      int rows = 0;
      for (int y = 30; y < kHeight - 30; ++y, ++rows) {
        red += light.at(x, y, 0) / (light.at(x, y, 0) + light.at(x, y, 1));
        away += depth.at(x, y);
      }
      red /= rows;
      away /= rows;
      const double at = (2.0 * (x + 0.5) / kWidth - 1.0) * away / frame.view.projection[0][0];
      worst = std::max(worst, std::abs(red - exact_share(at)));
      between += red > 0.1 && red < 0.9 ? 1 : 0;
      if (std::abs(at) > 1.3 * kReach * kRadius) {
        EXPECT_NEAR(red, at < 0.0 ? 1.0 : 0.0, 0.004) << "away from it nothing is mixed, m: " << at;
      }
    }
    EXPECT_LT(worst, 0.08);
    EXPECT_GE(between, 7) << "pixels from 10 to 90 %: hard it is two or three, along the particles' outlines";
  }
}

TEST_F(MixingTest, ADropBeforeAnotherFluidKeepsItsOutline) {
  // Half a metre before the green there is a red ball: neither has a share in the other.
  auto points = kit::jitter_lattice({-1.2f, -0.9f, -0.58f}, {1.2f, 0.9f, -0.5f}, kSpacing, 3);
  std::vector<std::uint8_t> fluids(points.size(), 0);
  for (const glm::vec3& p : kit::jitter_lattice(glm::vec3(-0.1f), glm::vec3(0.1f), kSpacing, 7)) {
    if (glm::length(p) > 0.1f) continue;
    points.push_back(p);
    fluids.push_back(1);
  }
  Frame frame = TwoFluids().frame(kWidth, kHeight);
  frame.particles = points;
  frame.particle_fluid = fluids;
  auto renderer = make(small());
  renderer->draw(frame);
  const FloatImage light = renderer->read_buffer(Buffer::kFinalColor);
  const FloatImage index = renderer->read_buffer(Buffer::kFluidIndex);
  int of_ball = 0;
  for (int y = 5; y < kHeight - 5; ++y) {
    for (int x = 5; x < kWidth - 5; ++x) {
      const bool ball = index.at(x, y) == 1.0f;
      of_ball += ball ? 1 : 0;
      ASSERT_GE(index.at(x, y), 0.0f);
      EXPECT_LT(light.at(x, y, ball ? 1 : 0), 0.01f * light.at(x, y, ball ? 0 : 1)) << x << ", " << y;
    }
  }
  EXPECT_GT(of_ball, 500);
}

TEST_F(MixingTest, OneFluidCostsNothingAndLooksTheSame) {
  TwoFluids two;
  std::ranges::fill(two.fluids, std::uint8_t{1});  // another is known, and not seen
  const Frame frame = two.frame(kWidth, kHeight);
  RenderOptions options = small();
  auto renderer = make(options);
  renderer->set_timing(true);
  const auto mixes = [&] {
    return std::ranges::count(renderer->pass_times(), std::string("mixing"), &PassTime::pass);
  };
  renderer->draw(frame);
  EXPECT_EQ(mixes(), 0);
  const Image soft = renderer->read_back();
  options.soft_mixing = false;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(frame);
  EXPECT_EQ(renderer->read_back().rgba, soft.rgba);

  options.soft_mixing = true;
  ASSERT_TRUE(renderer->set_options(options));
  const auto nearest =
      std::ranges::min_element(two.points, {}, [](const glm::vec3& p) { return glm::length(p); });
  two.fluids[static_cast<std::size_t>(nearest - two.points.begin())] = 0;
  renderer->draw(frame);
  EXPECT_EQ(mixes(), 1);
}

TEST_F(MixingTest, OfManyFluidsAnyTwoMixAlike) {
  // The same two looks as fluids 0 and 1, and as 2 and 7.
  TwoFluids two;
  auto renderer = make(small());
  renderer->draw(two.frame(kWidth, kHeight));
  const FloatImage expected = renderer->read_buffer(Buffer::kFinalColor);
  for (std::uint8_t& fluid : two.fluids) fluid = fluid == 0 ? 2 : 7;
  Frame frame = two.frame(kWidth, kHeight);
  const std::vector<FluidLook> looks = frame.fluids;
  frame.fluids.assign(16, opaque({0.0f, 0.0f, 1.0f}));
  frame.fluids[2] = looks[0];
  frame.fluids[7] = looks[1];
  renderer->draw(frame);
  const FloatImage drawn = renderer->read_buffer(Buffer::kFinalColor);
  float apart = 0.0f;
  for (std::size_t i = 0; i < drawn.values.size(); ++i)
    apart = std::max(apart, std::abs(drawn.values[i] - expected.values[i]));
  EXPECT_LT(apart, 2e-3f);
}

TEST_F(MixingTest, ByComputeShadersItIsTheSame) {
  const TwoFluids two;
  const Frame frame = two.frame(kWidth, kHeight);
  RenderOptions options = small();
  options.quality = Quality::kFull;
  std::vector<FloatImage> drawn;
  for (const PixelPasses way : {PixelPasses::kFragments, PixelPasses::kCompute}) {
    options.pixel_passes = way;
    auto renderer = make(options);
    renderer->draw(frame);
    drawn.push_back(renderer->read_buffer(Buffer::kFinalColor));
  }
  double apart = 0.0;
  for (std::size_t i = 0; i < drawn[0].values.size(); ++i)
    apart += std::abs(drawn[0].values[i] - drawn[1].values[i]) / static_cast<double>(drawn[0].values.size());
  EXPECT_LT(apart, 1e-3);
}

TEST(FluidMixture, TakesFromLightWhatItsPartsTake) {
  using namespace shader;
  const FluidMatter milk{vec3(0.9f), vec3(400.0f), 1.0f, 1.0f, 1.35f, 0.1f};
  const FluidMatter juice{vec3(0.8f, 0.3f, 0.1f), vec3(3.0f, 9.0f, 25.0f), 0.5f, 0.5f, 1.45f, 0.3f};
  const FluidMatter alone = matter_of(add_to_mixture(no_mixture(), juice, 3.0f));
  EXPECT_NEAR(alone.extinction.z, 25.0f, 1e-4f);
  EXPECT_NEAR(alone.color.y, 0.3f, 1e-5f);
  EXPECT_NEAR(alone.scattering, 0.5f, 1e-5f);
  EXPECT_NEAR(alone.refraction, 1.45f, 1e-5f);
  const FluidMatter mixed = matter_of(add_to_mixture(add_to_mixture(no_mixture(), milk, 1.0f), juice, 3.0f));
  EXPECT_NEAR(mixed.extinction.x, 0.25f * 400.0f + 0.75f * 3.0f, 1e-3f);
  EXPECT_NEAR(mixed.gloss, 0.25f + 0.75f * 0.5f, 1e-5f);
  EXPECT_NEAR(mixed.roughness, 0.25f * 0.1f + 0.75f * 0.3f, 1e-5f);
  EXPECT_GT(mixed.color.x, 0.88f) << "a quarter of milk is nearly all that gives red light back";
  EXPECT_GT(mixed.scattering, 0.75f);
  // Where both are opaque it is their shares that count, however opaque each is.
  FluidMatter red = milk;
  red.color = vec3(1.0f, 0.0f, 0.0f);
  FluidMatter green = milk;
  green.color = vec3(0.0f, 1.0f, 0.0f);
  green.extinction = vec3(4000.0f);
  const FluidMatter even = matter_of(add_to_mixture(add_to_mixture(no_mixture(), red, 1.0f), green, 1.0f));
  EXPECT_NEAR(even.color.x, 0.5f, 0.01f);
}

}  // namespace
}  // namespace slosh
