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
  double depth = 0.0;  ///< m, the deepest column that a fluid could stand in as it is placed
  double drop = 0.0;   ///< m, from the highest fluid to the floor of the domain
};
FluidHeights fluid_heights(const Scene& scene);

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

/// Fills the plan's depth, drop and sound_share on the way. Needs the scene's meshes.
StepLimit step_limit(const Scene& scene, Plan& plan);

/// s: a plan with a shorter sub-step is refused by make_world. At 1 cm it is some 5000 Pa·s.
inline constexpr double kShortestStep = 2.0e-6;

/// Why a plan would not come to an end, with what would do; nothing where it does. Needs no mesh.
std::optional<Error> refuse_endless(const Scene& scene, const Plan& plan);

/// The largest multiple of the scene's gravity at which the plan's step stays stable. Needs no mesh.
double most_gravity_allowed(const Scene& scene, const Plan& plan);

}  // namespace slosh
