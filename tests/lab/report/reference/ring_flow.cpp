#include "tests/lab/report/reference/ring_flow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slosh::report {
namespace {

double cube(double x) {
  return x * x * x;
}

}  // namespace

RingFlow::RingFlow(double inner, double outer, double viscosity, double density, int cells)
    : inner_(inner),
      viscosity_(viscosity),
      density_(density),
      width_((outer - inner) / cells),
      turning_(static_cast<std::size_t>(cells), 0.0) {}

void RingFlow::step(double dt, double inner_turning, double outer_turning) {
  constexpr int kImplicit = 2;
  if (steps_ < kImplicit) {
    go(0.5 * dt, 1.0, inner_turning, outer_turning);
    go(0.5 * dt, 1.0, inner_turning, outer_turning);
  } else {
    go(dt, 0.5, inner_turning, outer_turning);
  }
  ++steps_;
}

void RingFlow::go(double dt, double implicit_share, double inner_turning, double outer_turning) {
  const int n = static_cast<int>(turning_.size());
  // What a face passes on for each rad/s between its two sides; a wall is half a cell away.
  const auto passes = [&](int i) {
    return viscosity_ * cube(face(i)) / (i == 0 || i == n ? 0.5 * width_ : width_);
  };
  const auto before = [&](int i) {
    return i < 0 ? at_inner_ : i >= n ? at_outer_ : turning_[static_cast<std::size_t>(i)];
  };
  const double explicit_share = 1.0 - implicit_share;
  std::vector<double> above(turning_.size()), right(turning_.size());
  // Thomas' algorithm; the matrix is diagonally dominant.
  for (int i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double mass = density_ * 0.25 * (std::pow(face(i + 1), 4) - std::pow(face(i), 4)) / dt;
    const double low = passes(i), high = passes(i + 1);
    const double gains =
        explicit_share * (low * (before(i - 1) - before(i)) + high * (before(i + 1) - before(i)));
    double diagonal = mass + implicit_share * (low + high);
    right[at] = mass * turning_[at] + gains;
    if (i == 0) right[at] += implicit_share * low * inner_turning;
    if (i == n - 1) right[at] += implicit_share * high * outer_turning;
    if (i > 0) {
      const double below = -implicit_share * low;
      diagonal -= below * above[at - 1];
      right[at] -= below * right[at - 1];
    }
    above[at] = i + 1 < n ? -implicit_share * high / diagonal : 0.0;
    right[at] /= diagonal;
  }
  for (int i = n - 1; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    turning_[at] = right[at] - (i + 1 < n ? above[at] * turning_[at + 1] : 0.0);
  }
  at_inner_ = inner_turning;
  at_outer_ = outer_turning;
}

double RingFlow::inner_torque() const {
  // What the volumes are told that they got.
  return 2.0 * std::numbers::pi * viscosity_ * cube(inner_) * (at_inner_ - turning_[0]) / (0.5 * width_);
}

double RingFlow::turning_at(double radius) const {
  const int n = static_cast<int>(turning_.size());
  const double place = (radius - inner_) / width_ - 0.5;
  const int low = std::clamp(static_cast<int>(std::floor(place)), 0, n - 2);
  const auto at = static_cast<std::size_t>(low);
  return turning_[at] + (place - low) * (turning_[at + 1] - turning_[at]);
}

}  // namespace slosh::report
