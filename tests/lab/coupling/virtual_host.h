// A host of the coupling study in closed forms: one body, its couplings solved as sim solves them, and a
// load.
#pragma once

#include <vector>

#include "sim/bodies/body_solve.h"
#include "tests/lab/coupling/study.h"
#include "tests/lab/coupling/study_host.h"

namespace slosh::coupling {

/// A bucket's worth: 0.03 kg·m² at 2.5 kg, grips on a circle of 0.15 m.
class VirtualHost final : public StudyHost {
 public:
  VirtualHost(const Case& c, double time_step);

  void step(const std::vector<HandWord>& hands) override;

 private:
  Wrench external();
  void note_load(const Wrench& acting, const glm::dvec3& gained);

  Load kind_;
  double dt_;
  RigidBody rigid_;
  glm::dvec3 fluid_place_{0.0};
  glm::dvec3 fluid_velocity_{0.0};
};

}  // namespace slosh::coupling
