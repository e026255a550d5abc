#include "sim/passes/bonds/bonds.h"

#include "sim/math/lattice.h"

namespace slosh {

double bond_lengths(double spacing) {
  double lengths = 0.0;  // spacings
  for_each_in_lattice(static_cast<double>(kBondReach), [&](int, int, int, double r) { lengths += r; });
  return lengths * spacing;
}

double bond_stiffness(double modulus, double spacing) {
  return 12.0 * spacing * spacing * spacing * modulus / bond_lengths(spacing);
}

}  // namespace slosh
