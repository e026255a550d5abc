// Engagement: how a hand takes hold of what may be elsewhere, heavy or moving, without a jerk and without
// adding energy. Run by the host and by each device loop, on the same input, so that both ends of a coupling
// engage alike.
#pragma once

#include <cstdint>

#include "sim/math/coupling.h"
#include "sim/snapshot.h"

namespace slosh {

/// A coupling whose force differs from the one that acts already by less than this when the hand takes hold
/// engages as it is, without a ramp: a body that was settled into a hand before the run neither sags nor
/// creeps.
constexpr double kQuietForce = 2.0;    ///< N
constexpr double kQuietTorque = 0.05;  ///< N·m
/// Engagement ramp: the offset between a hand and where it holds closes at no more than this speed.
constexpr double kRampSpeed = 0.15;  ///< m/s
constexpr double kRampTurn = 1.0;    ///< rad/s
/// s over which that speed rises from 0 ...
constexpr double kRampRise = 0.5;
/// ... and the time constant, s, with which the rest of the offset closes.
constexpr double kRampEnd = 0.25;
/// s of silence (of a hand, or of body states) after which a hand that holds on re-engages: it may be
/// anywhere by then.
constexpr double kHoldAnew = 0.1;

/// s over which a hand that engages with a moving body loses its slip velocity: before a bucket that hangs in
/// one hand swings back.
constexpr double kSlipRise = 0.15;

/// Where another hand holds the same body, a hand that re-engages changes the force that acted when it began
/// by no more than this, and by twice that each kHoldDoubles s later; beyond, it slips. Two hands that come
/// back to a body turned away from both close their offsets each on its own way, and would pull against one
/// another. A weight that shifts is carried in the end.
constexpr double kHoldForce = 2.0;    ///< N
constexpr double kHoldTorque = 0.1;   ///< N·m
constexpr double kHoldDoubles = 1.0;  ///< s, simulated
/// A silent hand gives way while updates of another hand of the body are received: it keeps the force of its
/// last update, and so much more at most.
constexpr double kYieldForce = 2.0;   ///< N
constexpr double kYieldTorque = 0.1;  ///< N·m

/// The energy that a slipping hold may give the body beyond its hand's work: the force that acted when it
/// began, and kHoldForce, over this way. So a body that a silent hand helps to carry can be lifted a little,
/// and no hold drives one on.
constexpr double kHoldWay = 0.2;    ///< m
constexpr double kHoldAngle = 0.3;  ///< rad
/// s after which what was given may be given again ...
constexpr double kHoldRecovers = 20.0;
/// ... and the share of it, below which a hold that slips follows the body ever less, and holds by friction.
constexpr double kHoldEases = 0.4;

/// Who else holds the body.
enum class Company : std::uint8_t {
  kAlone,   ///< nobody
  kShared,  ///< another hand
  kSilent,  ///< another hand whose updates are received, while this one's are not
};

/// The state of one grip's hold. The hand engages where the force continues as it is, at the grip's velocity:
/// with its own pose less an offset, and its own velocity less its slip against the grip. The slip is given
/// up over kSlipRise (the offset grows by it meanwhile), the offset slowly after that, until the hand holds
/// where it is; where the hold slips it grows again (kHoldForce). So engaging never pulls harder than what
/// moving the body at kRampSpeed takes, however far away the hand is, and a hand that passes by does not
/// snatch the body away.
///
/// Passive but for two stated allowances. What the offset's change gives the spring is counted (given()):
/// giving it up towards the hand gives the force times the distance, at kRampSpeed at most; any other change
/// gives kHoldWay of the force at most, and then only takes. A spring that is stiffened keeps its force, not
/// its stretch (live stiffness). Owned by one thread; no allocation.
class Engagement {
 public:
  /// What the coupling uses in place of the hand.
  struct Held {
    Pose pose;
    Twist twist;
  };

  /// Call once a tick. `time` in simulated s, never falling; `hand`, `twist`: the hand as it is; `gains` as
  /// the world has them now; `grip` as it is, with the force that acts on the hand already (0 when none
  /// does). While not engaged the hand itself comes back.
  Held update(bool engaged, double time, const Pose& hand, const Twist& twist, const CouplingGains& gains,
              const GripState& grip, Company company = Company::kAlone);

  /// The force on the hand while its updates are received: what it keeps when it falls silent.
  void carries(const Wrench& on_hand) { carried_ = on_hand; }

  /// The next update() re-engages. What was given of the allowances stays given.
  void take_hold_anew();

  bool engaged() const { return engaged_; }
  bool took_hold() const { return took_hold_; }  ///< in the last update()
  /// Share of the force that the hand is given, 0–1, rising over kRampRise where the hold was not a quiet
  /// one: the body goes on being carried as it was, but a hand that takes over a weight must not be struck by
  /// it.
  double felt() const { return !engaged_ ? 0.0 : quiet_ ? 1.0 : pace(); }
  /// J that the last update() put into the spring by moving where the hand holds, by no motion of the hand's;
  /// < 0 where it took some out.
  double given() const { return given_; }
  /// m and rad by which the hand is ahead of where it holds.
  double distance() const { return glm::length(offset_); }
  double angle() const { return glm::length(rotation_between(turn_, glm::dquat(1.0, 0.0, 0.0, 0.0))); }

 private:
  /// Where it holds and how fast, while an update() works it out.
  struct Work;

  void take_hold(double time, const Pose& hand, const Twist& twist, const CouplingGains& gains,
                 const GripState& grip);
  void keep_force(const Pose& hand, const CouplingGains& gains, const GripState& grip);
  void meet(Company company, double time);
  void slip(Work& work, double time);
  void ramp_work(Work& work, const Pose& hand);
  void bound_pull(Work& work, const Twist& hand);
  Held settle(const Work& work, const Pose& hand, const Twist& twist);
  Pose place(const Pose& hand) const;
  bool firm() const;
  double allowance() const;          // J that may be given in all ...
  double turning_allowance() const;  // ... by forces, and by torques
  double most_pull() const;          // N and
  double most_twist() const;         // N·m by which the force may differ from began_
  double slip_pace() const;          // 0–1 over kSlipRise
  double pace() const;               // 0–1 over kRampRise

  bool engaged_ = false;
  bool took_hold_ = false;
  bool quiet_ = true;
  bool anew_ = false;  // stored_ is of the hold before
  Company company_ = Company::kAlone;
  CouplingGains gains_;
  Wrench began_;    // on the hand when it engaged, or at its last update
  Wrench carried_;  // what acts on it while its updates are received
  double since_ = 0.0;
  double last_ = 0.0;
  double share_ = 1.0;  // of the allowances, left
  double turning_share_ = 1.0;
  double given_ = 0.0;   // J
  double stored_ = 0.0;  // J in the springs
  double turning_stored_ = 0.0;
  glm::dvec3 offset_{0.0};               // hand less what it holds with, m
  glm::dquat turn_{1.0, 0.0, 0.0, 0.0};  // what it holds with in the hand's frame, so that both turn alike
  glm::dvec3 slip_{0.0};                 // of the hand against the grip when it engaged, m/s
  glm::dvec3 slip_turn_{0.0};            // rad/s
  glm::dvec3 speed_{0.0};                // of what it holds with, towards the hand, m/s
  glm::dvec3 turning_{0.0};              // rad/s
};

}  // namespace slosh
