// How long a step may be with Eq 6 and 9 explicit.
#pragma once

#include "sim/fluid_extremes.h"
#include "sim/plan.h"
#include "sim/viscosity/wall_drag.h"

namespace slosh {

/// Pa·s, the most of any body, where the most viscous fluid has so much.
double most_viscous_body(const Scene& scene, double most_viscous_fluid);

/// s, the longest step at which explicit viscosity stays stable.
double viscous_step(const Scene& scene, const Plan& plan, const FluidExtremes& fluids);

/// s, the longest step at which artificial viscosity stays stable where nothing else is explicit.
double artificial_viscosity_step(const Scene& scene, const Plan& plan, const FluidExtremes& fluids);

/// The explicit viscosity, Pa·s, up to which the plan's step takes no more than 0.8 of a particle's velocity
/// among neighbours that stand still. Infinite without fluid.
double max_explicit_viscosity(const Scene& scene, const Plan& plan);

/// The largest viscosity of a fluid, Pa·s, at which the plan's step stays stable with walls' viscous force
/// from `layer`. Needs no mesh.
double max_viscosity_allowed(const Scene& scene, const Plan& plan, DragLayer layer);

}  // namespace slosh
