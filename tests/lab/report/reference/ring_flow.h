// Fluid between two long cylinders that turn as they like: what a gap does until it flows evenly.
#pragma once

#include <vector>

namespace slosh::report {

/// Creeping or not, a flow round the axis alone: ρ r³ ∂ω/∂t = ∂/∂r(μ r³ ∂ω/∂r), ω the angular velocity at r.
/// Finite volumes in r, the second order in cell and step (Crank and Nicolson, after two implicit halves that
/// take a sudden start's jump out).
class RingFlow {
 public:
  /// 0 < inner < outer, m; viscosity Pa·s and density kg/m³, > 0. At rest.
  RingFlow(double inner, double outer, double viscosity, double density, int cells = 400);

  /// Goes on by `dt` s to walls that turn at `inner_turning` and `outer_turning` rad/s from now on.
  void step(double dt, double inner_turning, double outer_turning);

  /// N·m a metre that the inner wall gives the fluid.
  double inner_torque() const;
  /// rad/s at `radius`, m, between the walls.
  double turning_at(double radius) const;

 private:
  double face(int i) const { return inner_ + i * width_; }
  void go(double dt, double implicit_share, double inner_turning, double outer_turning);

  double inner_, viscosity_, density_, width_;
  double at_inner_ = 0.0, at_outer_ = 0.0;  // rad/s
  int steps_ = 0;
  std::vector<double> turning_;  // rad/s of each cell
};

}  // namespace slosh::report
