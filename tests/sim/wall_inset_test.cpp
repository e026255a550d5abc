// How deep a wall's boundary layer lies.
#include "sim/walls/wall_inset.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/math/kernels.h"
#include "sim/passes/pressure_force/pair_pressure.h"

namespace slosh {
namespace {

// The density that a lattice's half space above the wall has in its first layer, over a whole lattice's: sums
// over a plane as integrals, which for whole layers is no more than a percent off.
double first_layers_density(double ratio, double from_sheet) {
  const auto plane = [&](double height) {
    double sum = 0.0;
    constexpr int kRings = 2000;
    for (int n = 0; n < kRings; ++n) {
      const double r = (n + 0.5) * ratio / kRings;
      sum +=
          2.0 * 3.141592653589793 * r * spiky_shape<double>(r * r + height * height, ratio) * ratio / kRings;
    }
    return sum;
  };
  double own = plane(0.0), above = 0.0;
  for (int n = 1; n < ratio; ++n) above += plane(n);
  return (own + above + kWallShare * plane(from_sheet)) / (own + 2.0 * above);
}

// The first layer stands as far off the surface whatever the support: there its density is a lattice's.
TEST(WallInset, IsWhereTheFirstLayerHasALatticesDensity) {
  const double stands = 0.483;  // by the same at a ratio of 2
  for (const double ratio : {1.75, 2.0, 2.25, 2.5, 2.6}) {
    const double inset = wall_inset(ratio);
    EXPECT_NEAR(first_layers_density(ratio, inset + stands), 1.0, 0.004) << ratio;
  }
  EXPECT_GT(first_layers_density(2.5, kWallInset + stands), 1.05)
      << "where the boundary layer lay at every ratio";
}

TEST(WallInset, IsWhereItWasReadAtARatioOfTwo) {
  EXPECT_EQ(wall_inset(2.0), 0.7);
  EXPECT_NEAR(wall_inset(2.5), 0.799, 0.001);
  EXPECT_NEAR(wall_inset(1.5), 0.603, 0.001);
}

}  // namespace
}  // namespace slosh
