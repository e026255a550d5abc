// The host of the coupling study as its sites know it, whatever stands behind it.
#pragma once

#include <vector>

#include "peer/replica/body_replica.h"
#include "peer/replica/fluid_load.h"
#include "peer/replica/replica_history.h"
#include "sim/math/pose.h"

namespace slosh::coupling {

/// A hand's newest update at the host.
struct HandWord {
  double stamp = -1.0;  ///< s, when it was read
  Pose pose;
  Twist twist;
  bool engaged = true;
  double energy = 0.0;  ///< J
};

/// One body with a grip a hand. Its frame's origin is its centre of mass.
class StudyHost {
 public:
  virtual ~StudyHost() = default;

  /// A step of the length that it was made for.
  virtual void step(const std::vector<HandWord>& hands) = 0;

  const RigidMotion& motion() const { return motion_; }
  const std::vector<Pose>& grips() const { return grips_; }  ///< in the body's frame
  const CouplingGains& gains() const { return gains_; }
  const ReplicaBody& body() const { return body_; }
  const std::vector<Wrench>& on_hand() const { return on_hand_; }  ///< of the last step
  bool has_load() const { return has_load_; }                      ///< it says a model of its fluid
  const FluidLoad& load() const { return load_; }
  const Wrench& fluid() const { return fluid_; }  ///< on the body, in the last step
  /// J that the load gave the body so far; a weight that sinks gives.
  double given() const { return given_; }

 protected:
  RigidMotion motion_;
  std::vector<Pose> grips_;
  CouplingGains gains_;
  ReplicaBody body_;
  std::vector<Wrench> on_hand_;
  bool has_load_ = false;
  FluidLoad load_;
  Wrench fluid_;
  double given_ = 0.0;
};

}  // namespace slosh::coupling
