// What the best model of a family leaves of the water's force: the bound for any that is found as it goes.
#include <cmath>
#include <numbers>

#include "sim/math/dense.h"
#include "tests/lab/coupling/water_study.h"

namespace slosh::coupling {
namespace {

constexpr double kSplitPeriod = 0.001;  // s, of a step
constexpr double kAbout = 0.01;         // s over which a velocity's change is taken
constexpr double kLittle = 1e-9;

/// Least squares of one force on up to five motions and a constant.
class Fit {
 public:
  void add(const Vector6& x, double force) {
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) normal_[i][j] += x[i] * x[j];
      answer_[i] += x[i] * force;
    }
    square_ += force * force;
  }
  /// Sum of squares.
  double left() const {
    Matrix6 m = normal_, factor;
    for (std::size_t i = 0; i < 6; ++i) m[i][i] += kLittle;
    if (!cholesky(m, factor)) return square_;
    const Vector6 x = cholesky_solve(factor, answer_);
    double left = square_;
    for (std::size_t i = 0; i < 6; ++i) left -= x[i] * answer_[i];
    return std::max(left, 0.0);
  }

 private:
  Matrix6 normal_{};
  Vector6 answer_{};
  double square_ = 0.0;
};

/// The body's motion and the fluid's force along one axis, step by step.
struct Axis {
  std::vector<double> speed, pace, force;
};

Axis axis_of(const WaterRun& run, int axis) {
  Axis a;
  const auto about = static_cast<std::ptrdiff_t>(std::lround(0.5 * kAbout / kSplitPeriod));
  const auto count = static_cast<std::ptrdiff_t>(run.steps.size());
  const auto speed = [&](std::ptrdiff_t i) {
    return run.steps[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, count - 1))]
        .motion.twist.linear[axis];
  };
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    a.speed.push_back(speed(i));
    a.pace.push_back((speed(i + about) - speed(i - about)) /
                     (2.0 * static_cast<double>(about) * kSplitPeriod));
    a.force.push_back(run.steps[static_cast<std::size_t>(i)].fluid.force[axis]);
  }
  return a;
}

/// What a mode does on a body that goes as `a` does: its force and what it lifts, a kg.
void swing(const Axis& a, const SloshMode& mode, std::vector<double>& force, std::vector<double>& lift) {
  SloshState s;
  const SloshStep step(mode.pace, mode.damping, kSplitPeriod);
  force.assign(a.speed.size(), 0.0);
  lift.assign(a.speed.size(), 0.0);
  for (std::size_t i = 1; i < a.speed.size(); ++i) {
    s = step(s, a.speed[i] - a.speed[i - 1]);
    force[i] = slosh_force(mode, s);
    lift[i] = bowl_force(mode, s, a.pace[i]);
  }
}

}  // namespace

WaterSplit split_water(const WaterRun& run) {
  const auto begin = static_cast<std::size_t>(kWaterBegins / kSplitPeriod);
  double rigid = 0.0, modes = 0.0, level = 0.0, lifts = 0.0;
  std::vector<double> force, lift, lift_x, lift_z, best_force, best_lift, up_force;
  for (const int axis : {0, 2, 1}) {
    const Axis a = axis_of(run, axis);
    const auto left = [&](const std::vector<double>* mode, bool lifted) {
      Fit fit;
      for (std::size_t i = begin; i < a.force.size(); ++i)
        fit.add({1.0, a.pace[i], a.speed[i], mode ? (*mode)[i] : 0.0, lifted ? lift_x[i] : 0.0,
                 lifted ? lift_z[i] : 0.0},
                a.force[i]);
      return fit.left();
    };
    const double without = left(nullptr, false);
    double best = without;
    best_force.assign(a.force.size(), 0.0);
    best_lift = best_force;
    for (double hertz = 1.4; hertz < 3.5; hertz *= 1.02) {
      for (const double damping : {0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.2}) {
        swing(a, {1.0, 2.0 * std::numbers::pi * hertz, damping}, force, lift);
        const double now = left(&force, false);
        if (now >= best) continue;
        best = now;
        best_force = force;
        best_lift = lift;
      }
    }
    rigid += without;
    modes += best;
    if (axis == 0) lift_x = best_lift;
    if (axis == 2) lift_z = best_lift;
    if (axis == 1)
      lifts = level + left(&best_force, true);
    else
      level += best;
  }
  const double whole = water_force(run) * std::sqrt(static_cast<double>(run.steps.size() - begin));
  return {std::sqrt(rigid) / whole, std::sqrt(modes) / whole, std::sqrt(lifts) / whole};
}

}  // namespace slosh::coupling
