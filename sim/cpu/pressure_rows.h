// Who presses on whom, as forces and the solves for pressures and for drag ask for it.
#pragma once

#include <vector>

#include "sim/cpu/pair_rows.h"

namespace slosh {

/// What a particle's own stress pushes with, without the kernel's constant: a tensor as a walk over rows
/// takes it, xx, yy, zz; xy, yz, zx; xz, yx, zy; and `own` by what it pushes itself, N.
struct alignas(64) PassedStress {
  Vector4 straight, turning, back, own;
};

/// What the density pass of the corrected and of the incompressible model writes down of fluid particles, four
/// entries more than there are particles.
struct FluidPress {
  PairRows rows;
  std::vector<Vector4> places;       ///< m, with 0 for a fourth
  std::vector<Vector4> velocities;   ///< m/s, with 1 for a fourth
  /// What each presses by, with the kernel's constant: at 1 Pa where pressures are solved for; and its volume,
  /// m³, and viscosity, Pa·s.
  std::vector<PressTensor> tensors;
  /// What its own pressure pushes each by, N (where pressures are solved for, of 1 Pa, m²), with 0 for a
  /// fourth: by fluid, walls and bodies.
  std::vector<Vector4> own;
  std::vector<Vector4> drags;  ///< what each drags by, Pa·m, and in the fourth its volume, m³
  /// There with kFluidStress. `tensors` then have the viscosity that is left for Eq 9.
  std::vector<PassedStress> stresses;

  void clear(std::size_t particles, std::size_t chunks) {
    rows.clear(chunks);
    places.resize(particles + 4);
    velocities.resize(particles + 4);
    tensors.resize(particles + 4);
    own.resize(particles + 4);
    drags.resize(particles + 4);
  }
  void make_stresses(std::size_t particles) {
    stresses.resize(particles + 4);
    stresses[particles] = {};  // nobody's, who fills rows up
  }
};

}  // namespace slosh
