// How long a step may be, and what a live change of the world may come to at the step that was chosen.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "scenes/scene.h"
#include "sim/math/result.h"
#include "sim/plan.h"

namespace slosh {

struct FluidHeights {
  double depth = 0.0;  ///< m, the deepest column that the volumes make, one on the other as they are placed
  double load = 0.0;   ///< m of the heaviest fluid that would weigh as much as the heaviest of those columns
  double drop = 0.0;   ///< m, from the highest fluid to the floor of the domain
};
FluidHeights fluid_heights(const Scene& scene);

/// m/s, the fastest that a start velocity or a scripted hand moves fluid, or any point of a body, up to 20.
double driven_speed(const Scene& scene);

/// kg/m³ that Eq 7 takes for a fluid of `density`. The paper's: its own, one k for all. Else the heaviest
/// fluid's, so that k goes with the inverse of the density and the same pressure compresses all fluids alike:
/// with one k a light fluid under a heavy one would be squeezed by the ratio of their densities.
double pressing_density(const Scene& scene, double density);

/// The largest step that each limit allows; the plan takes the smallest and says which it was.
struct StepLimit {
  double step = std::numeric_limits<double>::infinity();  ///< s
  std::string reason;

  void lower_to(double other, std::string why) {
    if (other < step) {
      step = other;
      reason = std::move(why);
    }
  }
};

/// Fills the plan's depth, drop, driven speed and sound_share on the way. Needs the scene's meshes.
StepLimit step_limit(const Scene& scene, Plan& plan);

/// s: how soon pressure projection undoes a particle's compression. One step, but the flow's own step where
/// that is more than four times as long (most viscous fluid): a rounding's compression undone in 0.03 ms is a
/// speed. `gravity`, m/s²; `dt`, s.
double density_time(const Plan& plan, double gravity, double dt);

/// s: a plan with a shorter sub-step is refused by make_world. At 1 cm it is some 5000 Pa·s.
inline constexpr double kShortestStep = 2.0e-6;

/// Why a plan would not come to an end, with what would do; nothing where it does. Needs no mesh.
std::optional<Error> refuse_endless(const Scene& scene, const Plan& plan);

/// The largest multiple of the scene's gravity at which the plan's step stays stable. Needs no mesh.
double most_gravity_allowed(const Scene& scene, const Plan& plan);

}  // namespace slosh
