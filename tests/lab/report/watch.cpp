#include "tests/lab/report/watch.h"

#include <algorithm>
#include <cmath>

namespace slosh::report {

void Watch::look(const Diagnostics& fluid) {
  if (energy_ > 0.0) largest_energy_ = std::max(largest_energy_, fluid.kinetic_energy / energy_);
}

void Watch::run(double seconds, const std::function<void()>& each) {
  const double dt = trial_.world().plan().time_step;
  // Without gravity a step's impulse is measured by what 1 g would be.
  const double g = std::max(glm::length(gravity_), kGravity);
  Diagnostics before = trial_.world().diagnostics();
  trial_.run(seconds, [&] {
    if (each) each();
    const Diagnostics after = trial_.world().diagnostics();
    look(after);
    // Whoever leaves takes its momentum along.
    if (after.particles == before.particles && before.mass > 0.0) {
      glm::dvec3 on_bodies(0.0);
      for (const BodyState& body : trial_.bodies().bodies) on_bodies += body.fluid.force;
      // What walls took in this step, bodies get in the next; what they got in this, they took in the last.
      const glm::dvec3 given =
          dt * (before.mass * gravity_ - on_bodies) + before.clamp_impulse - after.clamp_impulse;
      // Rounding of float velocities counts against what moves as well as against the weight.
      const double scale = dt * before.mass * g + 1e-3 * glm::length(before.momentum);
      worst_momentum_ =
          std::max(worst_momentum_, glm::length(after.momentum - before.momentum - given) / scale);
    }
    before = after;
  });
}

void Watch::run_far(double seconds, const std::function<void()>& each) {
  trial_.run(seconds, [&] {
    if (each) each();
    if (trial_.bodies().tick % 50 == 0) look(trial_.world().diagnostics());
  });
}

Stress Watch::found(double most_lost) const {
  Stress stress;
  stress.finite = all_finite(trial_.world());
  stress.energy_ratio = largest_energy_;
  stress.momentum_error = worst_momentum_;
  const double count = static_cast<double>(trial_.world().fluid_count());
  if (count > 0.0) stress.lost_share = static_cast<double>(trial_.world().diagnostics().retired) / count;
  stress.most_lost = most_lost;
  return stress;
}

}  // namespace slosh::report
