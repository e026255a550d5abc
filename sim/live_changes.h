// What may be changed while a world runs, and what its time step allows.
#pragma once

#include <vector>

#include "sim/math/result.h"
#include "sim/plan.h"
#include "sim/viscosity/wall_drag.h"

namespace slosh {

/// As World::set_grip_stiffness.
Result<bool> allow_grip_stiffness(const Scene& scene, std::size_t grip, double scale);

class LiveChanges {
 public:
  /// `scene` as it starts.
  LiveChanges(const Scene& scene, const Plan& plan);

  /// Whether a fluid's viscosity may become `pascal_seconds`. `scene` as it is now. Errors as
  /// World::set_viscosity.
  Result<bool> allow_viscosity(const Scene& scene, const Plan& plan, std::size_t fluid,
                               double pascal_seconds) const;
  Result<bool> allow_gravity(const Scene& scene, const Plan& plan, double scale) const;

  /// Pa·s, as the scene had it at the start.
  double first_viscosity(std::size_t fluid) const { return first_viscosities_[fluid]; }

 private:
  std::vector<double> first_viscosities_;
  DragLayer layer_;
};

}  // namespace slosh
