// What a lattice passes on of a stress, by how the drag of a pair falls off with distance.
#include "sim/viscosity/drag_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/passes/pair_viscosity/pair_viscosity.h"

namespace slosh {
namespace {

struct PassedOn {  // in what Newton's fluid passes on
  double strain;   // along the axes of the lattice
  double shear;    // in its planes
};

/// Eq 9's drag along d between particles a unit apart in a cubic lattice that moves as v = A x:
/// the power that it takes a volume is V/2 Σ 5 ∇²W (d · A d)²/r².
PassedOn passed_on(const DragShape<double>& shape, double ratio) {
  const int reach = static_cast<int>(std::ceil(ratio));
  PassedOn sum{0.0, 0.0};
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double r = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        if (r == 0.0 || r >= ratio) continue;
        const double drag = 0.5 * static_cast<double>(kCentralDrag) * Spiky::scale(ratio) *
                            shape(Spiky::laplacian(r, ratio)) / (r * r);
        sum.strain += drag * std::pow(x * x - y * y, 2) / 4.0;
        sum.shear += drag * std::pow(x * y, 2);
      }
    }
  }
  return sum;
}

/// The same of layers a unit apart that slide over each other, in the mean over where one lies over the next.
double sliding_layers_pass_on(const DragShape<double>& shape, double ratio) {
  constexpr int kPlaces = 20;
  const int reach = static_cast<int>(std::ceil(ratio));
  double sum = 0.0;
  for (int place = 0; place < kPlaces * kPlaces; ++place) {
    for (int i = -reach; i <= reach; ++i) {
      for (int k = -reach; k <= reach; ++k) {
        for (int layer = 1; layer < reach; ++layer) {
          const double x = i + (place % kPlaces + 0.5) / kPlaces, z = k + (place / kPlaces + 0.5) / kPlaces;
          const double r = std::sqrt(x * x + z * z + layer * layer);
          if (r >= ratio) continue;
          sum += std::pow(x * layer, 2) * shape(Spiky::laplacian(r, ratio)) / (r * r);
        }
      }
    }
  }
  return static_cast<double>(kCentralDrag) * Spiky::scale(ratio) * sum / (kPlaces * kPlaces);
}

const DragShape<double> kLaplacian{1.0, 0.0};
constexpr double kSlides = 1.04;  // by how much thick fluid drags more

DragShape<double> scaled(const DragShape<double>& shape, double by) {
  return {by * shape.level, by * shape.growth};
}

TEST(DragShapeTest, ALatticePassesOnAStrainAsItDoesAShear) {
  const DragShape<double> shape = drag_shape(DragLayer::kSurface, 2.0);
  const PassedOn now = passed_on(scaled(shape, 1.0 / kSlides), 2.0);
  EXPECT_NEAR(now.strain, 1.0, 0.005);
  EXPECT_NEAR(now.shear, 1.0, 0.005);
  EXPECT_NEAR(passed_on(kLaplacian, 2.0).strain, 0.887, 0.001);
  EXPECT_NEAR(passed_on(kLaplacian, 2.0).shear, 1.055, 0.001);
}

TEST(DragShapeTest, LayersThatSlideOverEachOtherPassOnNewtons) {
  EXPECT_NEAR(sliding_layers_pass_on(drag_shape(DragLayer::kSurface, 2.0), 2.0), 1.0, 0.005);
  EXPECT_NEAR(sliding_layers_pass_on(kLaplacian, 2.0), 0.986, 0.001);
}

TEST(DragShapeTest, EvenlyLyingFluidPassesOnAsMuchAsByTheLaplacianAndWhatLayersLack) {
  // Σ shape r² over what lies evenly: ∫ shape r⁴ dr.
  const auto whole = [](const DragShape<double>& shape, double h) {
    constexpr int kParts = 10000;
    double sum = 0.0;
    for (int k = 0; k < kParts; ++k) {
      const double r = h * (k + 0.5) / kParts;
      sum += shape(Spiky::laplacian(r, h)) * std::pow(r, 4) * h / kParts;
    }
    return sum;
  };
  for (const double h : {0.01, 2.0}) {
    const DragShape<double> shape = drag_shape(DragLayer::kSurface, h);
    EXPECT_NEAR(whole(shape, h) / whole(kLaplacian, h), kSlides, 1e-6);
  }
}

TEST(DragShapeTest, ThinFluidKeepsTheLaplacian) {
  const DragShape<double> shape = drag_shape(DragLayer::kBehind, 0.01);
  EXPECT_EQ(shape.level, 1.0);
  EXPECT_EQ(shape.growth, 0.0);
}

}  // namespace
}  // namespace slosh
