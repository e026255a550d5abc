#include "sim/viscosity/wall_drag.h"

#include <cmath>

#include "sim/model.h"

namespace slosh {
namespace {

// Σ ∇²W d̂ d̂ᵀ of a plane square lattice `height` spacings away: along it (one direction) and across it, mean
// over where the particle stands over the lattice.
struct LayerDrag {
  double along = 0.0, across = 0.0;
};

template <class Kernel>
LayerDrag layer_drag(double height, double ratio) {
  constexpr int kPlaces = 10;
  const int reach = static_cast<int>(std::ceil(ratio)) + 1;
  LayerDrag sum;
  for (int place = 0; place < kPlaces * kPlaces; ++place) {
    const double x0 = static_cast<double>(place / kPlaces) / kPlaces;
    const double z0 = static_cast<double>(place % kPlaces) / kPlaces;
    for (int i = -reach; i <= reach; ++i) {
      for (int k = -reach; k <= reach; ++k) {
        const double x = i + x0, z = k + z0, r = std::sqrt(x * x + z * z + height * height);
        if (r <= 0.0 || r >= ratio) continue;
        const double pull = Kernel::laplacian(r, ratio) / (r * r * kPlaces * kPlaces);
        sum.along += pull * x * x;
        sum.across += pull * height * height;
      }
    }
  }
  return sum;
}

template <class Kernel>
WallDrag computed(double ratio) {
  const int reach = static_cast<int>(std::ceil(ratio));
  double stress = 0.0, wall = 0.0, whole = layer_drag<Kernel>(0.0, ratio).along;
  for (int n = 1; n <= reach; ++n) {
    const LayerDrag layer = layer_drag<Kernel>(n, ratio);
    stress +=
        n * n * layer.along;  // n pairs of layers that far apart lie across a plane, n spacings of shear each
    whole += 2.0 * layer.along;
  }
  for (int n = 0; n < reach; ++n)
    wall += (kFirstLayer + n) * layer_drag<Kernel>(kWallInset + kFirstLayer + n, ratio).along;
  WallDrag drag;
  if (wall > 0.0) drag.factor = stress / wall;
  const LayerDrag first = layer_drag<Kernel>(kWallInset + kFirstLayer, ratio);
  drag.rate = drag.factor * (first.along + first.across) / whole;
  return drag;
}

}  // namespace

WallDrag wall_drag(ParticleModel model, double support_ratio) {
  if (model != ParticleModel::kCorrected) return {};
  return computed<ModelParts<ParticleModel::kCorrected>::ForceKernel>(support_ratio);
}

}  // namespace slosh
