#include "host/auto_spacing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "net/clock.h"
#include "scenes/sample.h"
#include "sim/plan.h"
#include "sim/world.h"

namespace slosh {
namespace {

struct Line {
  double at_zero = 0.0;  // s
  double each = 0.0;     // s a particle
  double operator()(double particles) const { return at_zero + each * particles; }
};

Line fit(std::span<const StepTiming> timings) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const StepTiming& t : timings) {
    n += 1;
    sx += t.particles;
    sy += t.step;
    sxx += t.particles * t.particles;
    sxy += t.particles * t.step;
  }
  const double spread = n * sxx - sx * sx;
  const Line through_zero{0.0, sxx > 0 ? sxy / sxx : 0.0};
  if (spread <= 1e-9 * n * sxx) return through_zero;
  const double each = (n * sxy - sx * sy) / spread;
  const double at_zero = (sy - each * sx) / n;
  // A noisy pair can ask for negative costs. A line through zero is then the careful reading; a falling one
  // means that the particles' share drowned in the noise.
  if (at_zero < 0.0 || each <= 0.0) return through_zero;
  return {at_zero, each};
}

std::string sentence(const SpacingChoice& c, double margin) {
  char text[320];
  if (c.real_time) {
    std::snprintf(text, sizeof text,
                  "the finest spacing in the scene's range that keeps real time: about %.0f particles take "
                  "%.2f ms of each %.2f ms step (with a margin of %.1f)",
                  c.particles, 1e3 * c.predicted_step, 1e3 * c.time_step, margin);
  } else {
    std::snprintf(text, sizeof text,
                  "the scene's coarsest, and still slower than real time here: about %.0f particles take "
                  "%.2f ms of each %.2f ms step (with a margin of %.1f)",
                  c.particles, 1e3 * c.predicted_step, 1e3 * c.time_step, margin);
  }
  return text;
}

Result<StepTiming> time_steps(const Scene& scene, double spacing, const SpacingOptions& options) {
  Result<SampledScene> sampled = sample_scene(scene, spacing);
  if (!sampled) return sampled.error();
  Result<World> made =
      make_world(scene, sampled.value(), make_plan(scene, spacing),
                 {.threads = options.threads, .backend = options.backend, .gpu = options.gpu});
  if (!made) return made.error();
  World& world = made.value();

  // The hands hold on where the scene starts, so that the measured world does what the played one will.
  BodySnapshot bodies;
  world.fill(bodies);
  std::vector<HandleInput> hands;
  for (const GripState& grip : bodies.grips) hands.push_back({grip.pose, Twist{}, true, 1.0});

  constexpr int kWarmUp = 10;
  for (int i = 0; i < kWarmUp; ++i) world.step(hands);
  std::vector<double> times;
  const std::int64_t end_ns = steady_now_ns() + to_nanoseconds(options.seconds_each);
  while (times.size() < 20 || (steady_now_ns() < end_ns && times.size() < 5000)) {
    const std::int64_t begin_ns = steady_now_ns();
    world.step(hands);
    times.push_back(to_seconds(steady_now_ns() - begin_ns));
  }
  // A high percentile rather than the median: the host has to keep up on a bad moment too, and slow moments
  // of a shared machine should make the choice careful.
  const std::size_t place = times.size() * 3 / 4;
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(place), times.end());
  const auto particles = static_cast<double>(world.fluid_count() + world.boundary_count());
  return StepTiming{spacing, particles, times[place]};
}

}  // namespace

SpacingChoice choose_spacing(std::span<const StepTiming> timings,
                             std::span<const SpacingCandidate> candidates, double margin) {
  const Line cost = fit(timings);
  SpacingChoice best;
  const SpacingCandidate* coarsest = nullptr;
  for (const SpacingCandidate& candidate : candidates) {
    if (coarsest == nullptr || candidate.spacing > coarsest->spacing) coarsest = &candidate;
    const double predicted = cost(candidate.particles);
    const bool fits = predicted * margin <= candidate.time_step;
    if (!fits || (best.real_time && candidate.spacing >= best.spacing)) continue;
    best = {candidate.spacing, candidate.particles, candidate.time_step, predicted, true, {}};
  }
  if (!best.real_time && coarsest != nullptr) {
    best = {
        coarsest->spacing, coarsest->particles, coarsest->time_step, cost(coarsest->particles), false, {}};
  }
  best.reason = sentence(best, margin);
  return best;
}

std::vector<SpacingCandidate> spacing_candidates(const Scene& scene) {
  std::vector<SpacingCandidate> candidates;
  const auto add = [&](double spacing) {
    const ParticleEstimate estimate = estimate_particles(scene, spacing);
    candidates.push_back({spacing, estimate.fluid + estimate.surface, make_plan(scene, spacing).time_step});
  };
  add(scene.spacing_max);
  for (double spacing = scene.spacing_max / 1.04; spacing >= scene.spacing_min; spacing /= 1.04) {
    const double rounded = std::max(scene.spacing_min, std::round(spacing * 1e4) * 1e-4);
    if (rounded < candidates.back().spacing) add(rounded);
  }
  return candidates;
}

Result<SpacingChoice> measure_spacing(const Scene& scene, const SpacingOptions& options) {
  std::vector<StepTiming> timings;
  const double coarse = scene.spacing_max;
  const double finer = std::max(scene.spacing_min, 0.75 * scene.spacing_max);
  for (const double spacing : {coarse, finer}) {
    if (options.tell) {
      char text[64];
      std::snprintf(text, sizeof text, "steps at a spacing of %.1f mm", 1e3 * spacing);
      options.tell(text);
    }
    Result<StepTiming> timing = time_steps(scene, spacing, options);
    if (timing) {
      timings.push_back(timing.value());
    } else if (timings.empty()) {
      return timing.error();
    }
    if (finer >= coarse) break;
    // When the coarsest is hopeless already, a finer measurement would only cost time.
    if (timing && timing.value().step > 4.0 * make_plan(scene, spacing).time_step) break;
  }
  // The estimate misses what sampling leaves out near walls; the measured count puts it right.
  std::vector<SpacingCandidate> candidates = spacing_candidates(scene);
  const double estimated = candidates.front().particles;
  const double correction = estimated > 0.0 ? timings.front().particles / estimated : 1.0;
  for (SpacingCandidate& candidate : candidates) candidate.particles *= correction;
  return choose_spacing(timings, candidates);
}

}  // namespace slosh
