#include "sim/walls/wall_inset.h"

#include <cmath>

#include "sim/math/kernels.h"
#include "sim/model.h"
#include "sim/passes/pressure_force/pair_pressure.h"

namespace slosh {
namespace {

// What a plane square lattice of particles `height` spacings off adds to a particle's density: the kernel's
// shape, mean over where the particle stands over it.
double plane_density(double height, double ratio) {
  constexpr int kPlaces = 16;  // along each axis
  const int reach = static_cast<int>(std::ceil(ratio)) + 1;
  double sum = 0.0;
  for (int place = 0; place < kPlaces * kPlaces; ++place) {
    const double x0 = (place / kPlaces + 0.5) / kPlaces, z0 = (place % kPlaces + 0.5) / kPlaces;
    for (int i = -reach; i <= reach; ++i) {
      for (int k = -reach; k <= reach; ++k)
        sum += spiky_shape<double>((i + x0) * (i + x0) + (k + z0) * (k + z0) + height * height, ratio);
    }
  }
  return sum / (kPlaces * kPlaces);
}

// How far the layer, which counts kWallShare times, is from the first of evenly spaced layers when it adds to
// that one's density what the layers in its place would.
double boundary_to_fluid_layer(double ratio) {
  double missing = 0.0;
  for (int n = 1; n < ratio; ++n) missing += plane_density(n, ratio);
  double near = 0.5, far = ratio;
  for (int turn = 0; turn < 50; ++turn) {
    const double middle = 0.5 * (near + far);
    (kWallShare * plane_density(middle, ratio) > missing ? near : far) = middle;
  }
  return near;
}

}  // namespace

double wall_inset(double support_ratio) {
  constexpr double kReadAt = 2.0;
  if (support_ratio == kReadAt) return kWallInset;
  return kWallInset + boundary_to_fluid_layer(support_ratio) - boundary_to_fluid_layer(kReadAt);
}

}  // namespace slosh
