#include "sim/math/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/cpu/simd.h"
#include "sim/passes/density/equation_of_state.h"

namespace slosh {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSupport = 0.02;  // m

double poly6(double r) {
  return Poly6::shape_scale(kSupport) * poly6_shape<double>(r * r, kSupport * kSupport);
}
double spiky(double r) {
  return Spiky::shape_scale(kSupport) * spiky_shape<double>(r * r, kSupport);
}

// ∫ W dV over the support, by shells.
template <class Kernel>
double integral(Kernel kernel) {
  constexpr int kShells = 20000;
  double sum = 0.0;
  for (int i = 0; i < kShells; ++i) {
    const double r = kSupport * (i + 0.5) / kShells;
    sum += kernel(r) * 4.0 * kPi * r * r * kSupport / kShells;
  }
  return sum;
}

TEST(Kernels, IntegrateToOne) {
  EXPECT_NEAR(integral(poly6), 1.0, 1e-5);
  EXPECT_NEAR(integral(spiky), 1.0, 1e-5);
}

TEST(Kernels, VanishFromTheSupportRadiusOn) {
  for (const double r : {kSupport, 1.5 * kSupport, 100.0}) {
    EXPECT_NEAR(poly6(r), 0.0, 1e-30);  // h² − r² by a fused multiply-add leaves h²'s rounding, cubed
    EXPECT_EQ(spiky(r), 0.0);
    EXPECT_EQ(kernel_reach<double>(r, kSupport), 0.0);
  }
}

TEST(Kernels, MatchTheirClosedForms) {
  const double h = kSupport;
  EXPECT_NEAR(poly6(0.0), 315.0 / (64.0 * kPi * h * h * h), 1.0);
  EXPECT_NEAR(poly6(0.01) / poly6(0.0), std::pow(1.0 - 0.25, 3), 1e-9);
  EXPECT_NEAR(spiky(0.01) / (15.0 / (kPi * h * h * h)), std::pow(0.5, 3), 1e-6);
}

TEST(Kernels, SpikyGradientIsTheSpikyKernelsDerivative) {
  for (const double r : {0.004, 0.01, 0.016}) {
    const double step = 1e-6;
    const double numeric = (spiky(r + step) - spiky(r - step)) / (2.0 * step);
    const double slope = Spiky::scale(kSupport) * Spiky::pair(r * r, kSupport, 1.0).slope_over_r * r;
    EXPECT_NEAR(numeric, -slope, 1e-4 * std::abs(numeric));
  }
}

// The viscosity kernel of Müller 2003 has ∇²W = 45/(πh⁶)(h − r): check it against the kernel itself.
TEST(Kernels, ViscosityLaplacianBelongsToTheViscosityKernel) {
  const double h = kSupport;
  const auto w = [&](double r) {
    return 15.0 / (2.0 * kPi * h * h * h) *
           (-r * r * r / (2.0 * h * h * h) + r * r / (h * h) + h / (2.0 * r) - 1.0);
  };
  for (const double r : {0.005, 0.01, 0.015}) {
    const double s = 1e-5;
    const double radial = (w(r + s) - 2.0 * w(r) + w(r - s)) / (s * s) + (w(r + s) - w(r - s)) / (s * r);
    EXPECT_NEAR(radial, Spiky::scale(h) * Spiky::pair(r * r, h, 1.0).laplacian, 1e-3 * std::abs(radial));
  }
}

TEST(Kernels, BatchesAgreeWithNumbers) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> radius(0.0f, 0.03f);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const float r = radius(random);
    const float h = static_cast<float>(kSupport);
    const float single = spiky_shape<float>(r * r, h);
    const float batch = spiky_shape<FloatBatch>(FloatBatch(r * r), FloatBatch(h)).get(0);
    EXPECT_NEAR(batch, single, 2e-6f * h * h * h);
  }
  for (float x = 1e-12f; x < 1e6f; x *= 3.7f) {
    const float expected = 1.0f / std::sqrt(x);
    EXPECT_NEAR(RealOps<FloatBatch>::inverse_sqrt(FloatBatch(x)).get(0), expected, 1e-6f * expected);
  }
}

TEST(Kernels, FirstLanesMarksExactlyTheFirst) {
  for (std::size_t count = 0; count <= kLanes; ++count) {
    const FloatBatch lanes = first_lanes(count);
    for (std::size_t i = 0; i < kLanes; ++i) EXPECT_EQ(lanes.get(i), i < count ? 1.0f : 0.0f);
  }
}

TEST(EffectiveCompression, KeepsTheShareOfTensionAskedFor) {
  EXPECT_EQ(effective_compression(0.1f, 0.0f), 0.1f);
  EXPECT_EQ(effective_compression(-0.4f, 0.0f), 0.0f);
  EXPECT_EQ(effective_compression(-0.4f, 1.0f), -0.4f);
  EXPECT_FLOAT_EQ(effective_compression(-0.4f, 0.25f), -0.1f);
}

}  // namespace
}  // namespace slosh
