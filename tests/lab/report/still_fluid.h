// Fluid that nothing moves, and what it moves by all the same.
#pragma once

#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/trial.h"

namespace slosh::report {

/// A tank 16 cm each way, full of a fluid of `density` kg/m³ and `viscosity` Pa·s, its floor at y = 0. Its
/// walls, body 0, have no viscosity of their own.
SceneBuilder full_tank(ParticleModel model, double density, double viscosity);

/// 0.5 Pa·s, 8 cm deep in a glass of 12 cm, body 0, that a hand turns by a stiff grip; all of it turns from
/// the start.
class TurningGlass {
 public:
  static constexpr double kRadius = 0.06, kDepth = 0.08;  ///< m
  static constexpr double kTurning = 16.0;                ///< rad/s

  TurningGlass(const Setting& setting, Cost& cost);

  Trial& trial() { return trial_; }
  /// Before each step: where the hand is.
  void turn();

 private:
  TurningGlass(const SceneBuilder& b, const Setting& setting, Cost& cost);

  Trial trial_;
};

struct Turnover {
  double all;   ///< m/s, rms over the particles of what each moves by in a tenth of a second
  double axis;  ///< m/s, upwards, the mean within 5 cm of the axis
};
/// Of a full_tank's fluid, 0.3 s after a second of settling.
Turnover turnover(Trial& trial);

}  // namespace slosh::report
