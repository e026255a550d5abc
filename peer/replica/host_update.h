// What the host says of a held body.
#pragma once

#include <cstdint>
#include <span>

#include "peer/replica/replica_history.h"
#include "sim/math/coupling.h"

namespace slosh {

/// What the host says of one grip of the body.
struct HostHand {
  bool engaged = false;
  Pose handle;              ///< as the step used it
  Wrench on_hand;           ///< that the step put on it, about the handle
  std::int64_t ack_ns = 0;  ///< of our own: when the reading that the state follows was read, and so much
                            ///< later as the step carried it on; 0 = none
  bool counted = false;     ///< somebody counts for it …
  double energy = 0.0;      ///< … the J that its person put in
};

/// The authoritative state update of the body after one step, as soon as it comes.
struct HostUpdate {
  std::int64_t now_ns = 0;  ///< when it came
  double time = 0.0;        ///< s, the body's time that the state belongs to
  double time_step = 0.0;   ///< s of one step of the host's; 0: not known, and each update is taken for one
  RigidMotion motion;
  std::span<const HostHand> hands;  ///< one a grip of the body
  double pace = 1.0;                ///< s of the body's time a s of `now_ns`' clock, 0–1
  bool tells_fluid = false;         ///< the host says what the fluid alone puts on the body:
  Wrench fluid{};                   ///< N, N·m about the centre of mass, the mean over the step
  bool felt = true;                 ///< an own hand feels the replica: else what swings is not looked for
};

}  // namespace slosh
