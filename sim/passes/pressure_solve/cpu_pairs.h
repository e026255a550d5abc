// Pressure pairs, as forces, pressure projection and implicit viscosity use them.
#pragma once

#include <vector>

#include "sim/cpu/pair_rows.h"
#include "sim/passes/pressure_force/near_rows.h"

namespace slosh {

/// What pairs need of a particle with a viscous stress, all in one line of the cache. Its stress, and without
/// pressure projection its pressure, is a tensor as a loop over rows takes it, with the kernel's constant.
struct alignas(64) Passed {
  Vector4 straight;  ///< xx, yy, zz; volume, m³
  Vector4 turning;   ///< xy, yz, zx; viscosity that is left for Eq 9, Pa·s
  Vector4 back;      ///< xz, yx, zy; 0
  Vector4 drags;     ///< as FluidPress::drags
};

/// What the density pass of the corrected and of the incompressible model writes down of fluid particles,
/// four entries more than there are particles.
struct FluidPress {
  /// One a run of fluid, and more; in the published model from `pressure_force`.
  std::vector<NearRows> near;
  PairRows rows;
  std::vector<Vector4> places;      ///< m, with 0 for a fourth
  std::vector<Vector4> velocities;  ///< m/s, with 1 for a fourth
  /// Each one's pressure tensor, with the kernel's constant: at 1 Pa with pressure projection; and its
  /// volume, m³, and viscosity, Pa·s.
  std::vector<PressureTensor> tensors;
  /// What its own pressure pushes each by, N (with pressure projection, of 1 Pa, m²), with 0 for a fourth: by
  /// fluid, walls and bodies.
  std::vector<Vector4> own;
  std::vector<Vector4> drags;  ///< viscosity times velocity, Pa·m, and in the fourth its volume, m³
  // There with kFluidStress:
  std::vector<Passed> passed;
  std::vector<Vector4> own_stress;  ///< what its own stress pushes each by, N, with 0 for a fourth

  void clear(std::size_t particles, std::size_t chunks) {
    rows.clear(chunks);
    places.resize(particles + 4);
    velocities.resize(particles + 4);
    tensors.resize(particles + 4);
    own.resize(particles + 4);
    drags.resize(particles + 4);
  }
  void make_passed(std::size_t particles) {
    passed.resize(particles + 4);
    passed[particles] = {};  // nobody's, who fills rows up
    own_stress.resize(particles + 4);
  }
};

}  // namespace slosh
