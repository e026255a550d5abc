// Sums over lattices: what a particle has around it where all lies evenly.
#pragma once

#include <cmath>

namespace slosh {

/// Calls f(x, y, z, r) for the places of a cubic lattice within `ratio` spacings of the one in the middle,
/// without that; all in spacings.
template <class F>
void for_each_in_lattice(double ratio, F&& f) {
  const int reach = static_cast<int>(std::ceil(ratio));
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double r = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        if (r > 0.0 && r < ratio) f(x, y, z, r);
      }
    }
  }
}

/// Along each axis, of for_each_in_layer().
inline constexpr int kPlacesOverLayer = 10;

/// Calls f(x, z, r) for the neighbours of a plane square lattice `height` spacings away, at each of
/// kPlacesOverLayer² places over it.
template <class F>
void for_each_in_layer(double height, double ratio, F&& f) {
  constexpr int kPlaces = kPlacesOverLayer;
  const int reach = static_cast<int>(std::ceil(ratio)) + 1;
  for (int place = 0; place < kPlaces * kPlaces; ++place) {
    const double x0 = static_cast<double>(place / kPlaces) / kPlaces;
    const double z0 = static_cast<double>(place % kPlaces) / kPlaces;
    for (int i = -reach; i <= reach; ++i) {
      for (int k = -reach; k <= reach; ++k) {
        const double x = i + x0, z = k + z0, r = std::sqrt(x * x + z * z + height * height);
        if (r > 0.0 && r < ratio) f(x, z, r);
      }
    }
  }
}

}  // namespace slosh
