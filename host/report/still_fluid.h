// Fluid that nothing moves, and what it moves by all the same.
#pragma once

#include "host/report/scene_builder.h"
#include "host/report/trial.h"

namespace slosh::report {

/// A tank 16 cm each way, full of a fluid of `density` kg/m³ and `viscosity` Pa·s, its floor at y = 0. Its
/// walls, body 0, have no viscosity of their own.
SceneBuilder full_tank(ParticleModel model, double density, double viscosity);

struct Turnover {
  double all;   ///< m/s, rms over the particles of what each moves by in a tenth of a second
  double axis;  ///< m/s, upwards, the mean within 5 cm of the axis
};
/// Of a full_tank's fluid, 0.3 s after a second of settling.
Turnover turnover(Trial& trial);

}  // namespace slosh::report
