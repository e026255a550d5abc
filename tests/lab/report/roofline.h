// What the heavy passes of a step must move and compute at least, beside what the machine can do: a roofline
// (Williams, Waterman & Patterson 2009). Estimates: each column once, pairs of fluid alone.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "sim/backend.h"
#include "sim/plan.h"
#include "tests/lab/report/ceilings.h"

namespace slosh::report {

/// Means over the fluid's particles.
struct PairCounts {
  double candidates = 0.0;  ///< in the 27 cells around a particle's, itself among them
  double neighbours = 0.0;  ///< of these within the support radius, without itself
};

/// Of about `samples` of the positions, evenly picked. `support_radius` in m.
PairCounts count_pairs(std::span<const glm::vec3> positions, double support_radius,
                       std::size_t samples = 20000);

/// Of a pass in a sub-step, a fluid particle.
struct PassWork {
  PassId pass;
  double bytes = 0.0;  ///< from and to memory
  double flops = 0.0;  ///< single precision; a fused multiply-add counts as two
};

/// sort_fluid, density and pressure_force, with what is fused into them, of a plan of the corrected model.
std::vector<PassWork> pass_work(const Plan& plan, const PairCounts& pairs, Backend backend);

/// FLOP/s that the ceilings allow at so many FLOP a byte.
double roof(const Ceilings& ceilings, double flops_per_byte);

}  // namespace slosh::report
