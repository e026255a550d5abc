// Who presses on whom, as the solve for pressures asks for it.
#pragma once

#include <vector>

#include "sim/cpu/pair_rows.h"

namespace slosh {

/// What the density pass writes down of fluid particles where pressures are solved for: four entries more
/// than there are particles.
struct FluidPress {
  PairRows rows;
  std::vector<Vector4> places;       ///< m, with 0 for a fourth
  std::vector<PressTensor> tensors;  ///< what each presses by at 1 Pa, K with the kernel's constant
  /// What 1 Pa of its own pushes each by, m², with 0 for a fourth: by fluid, walls and bodies.
  std::vector<Vector4> own;
  std::vector<Vector4> drags;  ///< what each drags by, Pa·m, and in the fourth its volume, m³

  void clear(std::size_t particles, std::size_t chunks) {
    rows.clear(chunks);
    places.resize(particles + 4);
    tensors.resize(particles + 4);
    own.resize(particles + 4);
    drags.resize(particles + 4);
  }
};

}  // namespace slosh
