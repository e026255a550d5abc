// What is kept an eye on while a stress case runs.
#pragma once

#include "tests/lab/report/stress_case.h"

namespace slosh::report {

/// Steps a trial and keeps its worst. Every body of the trial's scene must be measured or free.
class Watch {
 public:
  /// `energy`: J, what the fluid's kinetic energy may reach; 0: not looked at.
  Watch(Trial& trial, const Scene& scene, double energy = 0.0)
      : trial_(trial), gravity_(scene.gravity), energy_(energy) {}

  /// As Trial::run. Reads the fluid's momentum before and after every step.
  void run(double seconds, const std::function<void()>& each = {});
  /// The same, without looking at momentum: for what would take too long.
  void run_far(double seconds, const std::function<void()>& each = {});

  /// All so far, with what was retired as lost.
  Stress found(double most_lost = 0.0) const;

 private:
  void look(const Diagnostics& fluid);

  Trial& trial_;
  glm::dvec3 gravity_;
  double energy_;
  double largest_energy_ = 0.0, worst_momentum_ = 0.0;
};

}  // namespace slosh::report
