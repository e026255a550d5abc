// Which particle spacing this machine can simulate in real time.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/backend.h"
#include "sim/math/result.h"

namespace slosh {

/// A step's measured cost at one spacing.
struct StepTiming {
  double spacing = 0.0;    ///< m
  double particles = 0.0;  ///< fluid and surface particles
  double step = 0.0;       ///< s
};

/// What one spacing would mean.
struct SpacingCandidate {
  double spacing = 0.0;    ///< m
  double particles = 0.0;  ///< estimated
  double time_step = 0.0;  ///< s, the plan's
};

struct SpacingChoice {
  double spacing = 0.0;         ///< m
  double particles = 0.0;       ///< estimated
  double time_step = 0.0;       ///< s
  double predicted_step = 0.0;  ///< s a step, without the margin
  bool real_time = false;       ///< the prediction with its margin fits the time step
  std::string reason;           ///< one sentence with the numbers
};

constexpr double kSpacingMargin = 1.4;  ///< steps of a moving scene cost more than those of a resting one

/// The finest candidate whose predicted step, times `margin`, is below its time step; the coarsest when none
/// is. The prediction is the straight line (least squares, both coefficients >= 0) through the timings.
/// Pure. Needs at least one of each.
SpacingChoice choose_spacing(std::span<const StepTiming> timings,
                             std::span<const SpacingCandidate> candidates, double margin = kSpacingMargin);

/// Spacings from the scene's coarsest to its finest, about 4 % apart, in tenths of a millimetre.
std::vector<SpacingCandidate> spacing_candidates(const Scene& scene);

struct SpacingOptions {
  int threads = 0;  ///< what the run will use, 0 = all cores
  Backend backend = Backend::kAuto;
  int gpu = 0;                 ///< of the CUDA backend
  double seconds_each = 0.35;  ///< wall time of measuring at each of two spacings
  /// Told what is being measured; may be empty.
  std::function<void(const std::string&)> tell;
};

/// Measures real steps of the scene at its coarsest spacing and one finer, then chooses. Errors: the scene
/// cannot be sampled at its coarsest spacing.
Result<SpacingChoice> measure_spacing(const Scene& scene, const SpacingOptions& options);

}  // namespace slosh
