// The host of the coupling study: one body, its couplings solved as sim solves them, and a load.
#pragma once

#include <vector>

#include "peer/haptics/replica/fluid_load.h"
#include "peer/haptics/replica/replica_history.h"
#include "peer/verbs/coupling/study.h"
#include "sim/bodies/body_solve.h"

namespace slosh::coupling {

/// A hand's newest word at the host.
struct HandWord {
  double stamp = -1.0;  ///< s, when it was read
  Pose pose;
  Twist twist;
  bool engaged = true;
  double energy = 0.0;  ///< J
};

/// A bucket's worth: 0.03 kg·m² at 2.5 kg, grips on a circle of 0.15 m.
class VirtualHost {
 public:
  VirtualHost(const Case& c, double time_step);

  void step(const std::vector<HandWord>& hands);

  RigidMotion motion() const;
  const std::vector<Pose>& grips() const { return grips_; }  ///< in the body's frame
  const CouplingGains& gains() const { return gains_; }
  const RigidBody& body() const { return body_; }
  const std::vector<Wrench>& on_hand() const { return on_hand_; }  ///< of the last step
  const FluidLoad& load() const { return load_; }
  const Wrench& fluid() const { return fluid_; }  ///< on the body, in the last step
  /// J that the load gave the body so far; a weight that sinks gives.
  double given() const { return given_; }

 private:
  Wrench external();

  Load kind_;
  double dt_;
  CouplingGains gains_;
  RigidBody body_;
  std::vector<Pose> grips_;
  std::vector<Wrench> on_hand_;
  FluidLoad load_;
  Wrench fluid_;
  double given_ = 0.0;
  glm::dvec3 fluid_place_{0.0};
  glm::dvec3 fluid_velocity_{0.0};
};

}  // namespace slosh::coupling
