// What of a held body's fluid swings, along one axis: a mass on a spring and a damper.
#pragma once

#include <algorithm>
#include <cmath>

namespace slosh {

/// A slosh mode of the equivalent mechanical model (Abramson 1966; Ibrahim 2005): m·(d²r/dt² + a) = −k·r −
/// d·dr/dt for a body that accelerates by a, r: where the mass is against the body, k = m·ω², d = 2ζ·m·ω. Of
/// whatever m, ω and ζ > 0 it gives no more than it was given.
struct SloshMode {
  double mass = 0.0;     ///< kg, ≥ 0; 0: nothing swings
  double pace = 10.0;    ///< ω, rad/s, > 0
  double damping = 0.1;  ///< ζ, above 0, below 1
};

struct SloshState {
  double place = 0.0;  ///< r, m
  double speed = 0.0;  ///< m/s
};

/// N on the body.
inline double slosh_force(const SloshMode& mode, const SloshState& s) {
  return mode.mass * mode.pace * (mode.pace * s.place + 2.0 * mode.damping * s.speed);
}

/// N along what FluidLoad::bowl points against, for a bowl of 1 s²/m: the mass rises as it swings, on a bowl
/// whose steepness gives it its pace, and its weight and its going up and down press on the body.
/// `acceleration`: the body's along r.
inline double bowl_force(const SloshMode& mode, const SloshState& s, double acceleration) {
  const double faster = -acceleration - mode.pace * (mode.pace * s.place + 2.0 * mode.damping * s.speed);
  return mode.mass * mode.pace * mode.pace * (s.speed * s.speed + s.place * faster);
}

/// Exact over `dt` s in which the body's velocity changes evenly.
class SloshStep {
 public:
  SloshStep() = default;
  SloshStep(double pace, double damping, double dt) : per_change_(1.0 / (pace * pace * std::max(dt, 1e-9))) {
    const double fades = damping * pace, swings = pace * std::sqrt(1.0 - damping * damping);
    const double left = std::exp(-fades * dt), c = std::cos(swings * dt), s = std::sin(swings * dt) / swings;
    a_ = left * (c + fades * s);
    b_ = left * s;
    c_ = -left * pace * pace * s;
    d_ = left * (c - fades * s);
  }
  /// `change`: of the body's velocity, m/s.
  SloshState operator()(const SloshState& at, double change) const {
    const double rests = -change * per_change_;  // where the mass would come to rest
    const double off = at.place - rests;
    return {rests + a_ * off + b_ * at.speed, c_ * off + d_ * at.speed};
  }

 private:
  double per_change_ = 0.0;
  double a_ = 1.0, b_ = 0.0, c_ = 0.0, d_ = 1.0;
};

}  // namespace slosh
