#include "sim/passes/bonds/bonds.h"

#include <cmath>

namespace slosh {

double bond_lengths(double spacing) {
  double lengths = 0.0;  // spacings
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const double r = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        if (r < static_cast<double>(kBondReach)) lengths += r;
      }
    }
  }
  return lengths * spacing;
}

double bond_stiffness(double modulus, double spacing) {
  return 12.0 * spacing * spacing * spacing * modulus / bond_lengths(spacing);
}

}  // namespace slosh
