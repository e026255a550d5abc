// A held rigid body as this site has it: every coupling of it at the device loop's rate, drawn to the host's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "peer/replica/fluid_load.h"
#include "peer/replica/loop_delay.h"
#include "peer/replica/replica_history.h"
#include "sim/math/coupling.h"
#include "sim/snapshot.h"

namespace slosh {

/// What does not change of the body.
struct ReplicaBody {
  double mass = 1.0;                    ///< kg, > 0
  glm::dmat3 inertia{1.0};              ///< kg·m², about the centre of mass, body axes, positive definite
  glm::dvec3 center{0.0};               ///< centre of mass in the mesh frame, m
  bool point = false;                   ///< it does not turn
  glm::dvec3 gravity{0.0, -9.81, 0.0};  ///< m/s²
};

/// One coupling of the body.
struct ReplicaGrip {
  Pose pose;            ///< in the mesh frame
  CouplingGains gains;  ///< as the host has them
};

/// What moves one grip.
struct ReplicaHand {
  bool engaged = false;
  bool own = false;  ///< of this site: its newest reading; else relayed, and softened by its delay
  Pose handle;       ///< as the coupling uses it
  Twist twist;
  double energy = 0.0;  ///< J that its person put in so far, by their own count
};

/// The host's update of the body.
struct HostMotion {
  RigidMotion motion;
  std::int64_t ack_ns = 0;  ///< when the newest of our readings that it follows was read; 0 = none
  double work = 0.0;        ///< J that what acts besides couplings put into the body there (LoadWork)
  std::array<SloshState, 3> swings{};  ///< of FluidLoad::swings, then
};

/// Constants of the scheme.
struct ReplicaTuning {
  double softening = 0.7;         ///< of ω₀·(RTT + J), for hands of other sites
  double least_time = 0.05;       ///< s: T_c is this at least …
  double round_trips = 2.0;       ///< … and so many round trips
  double load_round_trips = 2.0;  ///< a change of the fluid's model acts over so many round trips
  bool follows_slosh = true;      ///< what of the fluid swings is found and goes on here
  double most_taken = 0.05;       ///< share of the kinetic energy that a tick may take for a ledger
};

class BodyReplica {
 public:
  /// Allocates all that it ever needs; `grips`: all couplings of the body.
  BodyReplica(const ReplicaBody& body, std::vector<ReplicaGrip> grips, const ReplicaTuning& tuning = {});

  /// Takes the host's motion for its own and forgets the rest: at first, after a reset, a pause or a silence.
  void restart(const RigidMotion& motion) noexcept;
  void become(const ReplicaBody& body) noexcept { body_ = body; }
  bool started() const { return started_; }

  void set_gains(std::size_t g, const CouplingGains& gains) noexcept { grips_[g].gains = gains; }
  /// By the body's time, as all here.
  void set_delay(const LoopDelay& delay) noexcept { delay_ = delay; }
  /// What acts besides couplings, weight and all, with the host's motion as its reference.
  void set_load(const FluidLoad& load) noexcept;

  /// A state of the host's: what it differs by from what was here when its input was read is taken over bit
  /// by bit.
  void receive(const HostMotion& host) noexcept;

  /// One step of `dt` s that ends at `now_ns`. `trust`: of the fluid's model, 0–1, by its age.
  void advance(const std::vector<ReplicaHand>& hands, double dt, std::int64_t now_ns,
               double trust = 1.0) noexcept;

  const RigidMotion& motion() const { return now_; }
  const FluidLoad& load() const noexcept { return load_; }  ///< as it acts
  GripState grip(std::size_t g) const noexcept;
  /// N·s/m and N·m·s/rad by which a spring of grip `g` across this delay is damped to half its bound (B ≥
  /// K·τ/√2).
  double damping(std::size_t g) const noexcept;
  double rotational_damping(std::size_t g) const noexcept;
  /// By how much hands of other sites are softened, 0–1.
  double softness() const noexcept { return soft_; }
  double time_constant() const noexcept;
  /// Of the stiffness of all couplings, the share that hands of other sites have, 0–1.
  double shared() const noexcept { return shared_; }
  /// J that the hands of other sites gave here beyond what their persons put in, worst of them.
  double excess() const noexcept { return excess_; }
  /// J that the load put into the body since restart(): the host's count as far as updates came, and from
  /// there on what it gave here.
  double work() const noexcept { return work_; }
  double work_received() const noexcept { return work_received_; }  ///< J: of that the host's count alone
  /// Share, 0–1, of the load's work here since the host's update that is trusted; the rest is taken out of
  /// the motion.
  void trust_load(double share) noexcept { load_trust_ = share; }
  /// J of the load's work that is trusted; of what came since the host's update the own hands' part alone, as
  /// nobody knows yet what the others did about theirs.
  double work_trusted() const noexcept {
    const double own = 1.0 - shared_, slosh = own * slosh_since(),
                 since = own * (work_ - work_received_) - slosh;
    return work_received_ + slosh + (since > 0.0 ? load_trust_ * since : since);
  }
  /// J that the body's motion and its couplings hold, those of other sites as soft as they are here. As of
  /// the last advance().
  double stored() const noexcept { return stored_; }

 private:
  /// J that what swings gave here since the host's update: what it had, so none of it is uncertain.
  double slosh_since() const noexcept { return slosh_work_ - slosh_received_; }
  Matrix6 mass_matrix() const noexcept;
  void compare(std::int64_t now_ns) noexcept;
  void follow_load(double dt) noexcept;
  void foresee_slosh(glm::dvec3 velocity) noexcept;
  void swing(const glm::dvec3& change, double dt) noexcept;
  void soften(const std::vector<ReplicaHand>& hands) noexcept;
  void share_out(const std::vector<ReplicaHand>& hands, Vector6& load) const noexcept;
  void settle(const std::vector<ReplicaHand>& hands, double dt) noexcept;
  double take(double energy) noexcept;
  void sum_up(const std::vector<ReplicaHand>& hands) noexcept;

  ReplicaBody body_;
  std::vector<ReplicaGrip> grips_;
  ReplicaTuning tuning_;
  LoopDelay delay_;
  FluidLoad load_;           // as it acts
  FluidLoad received_load_;  // as the host last said it
  bool loaded_ = false;
  RigidMotion now_;
  HostMotion word_;  // of the host, not compared yet
  bool has_word_ = false;
  MotionError pending_;                       // of the host's newest update, not taken over yet
  std::array<SloshState, 3> swings_;          // of load_.swings
  glm::dvec3 pace_{0.0};                      // m/s² of the body in the last step, without what was corrected
  std::array<SloshState, 3> swings_pending_;  // of the host's update of them, not taken over yet
  ReplicaHistory history_;
  struct Ledger {
    double given = 0.0;  // J that this hand gave here
    double base = 0.0;   // its person's count when the ledger began
    bool open = false;
  };
  std::vector<Ledger> ledgers_;
  double soft_ = 1.0;
  double rotational_soft_ = 1.0;
  double shared_ = 0.0;  // of all stiffness, what hands of other sites have
  double excess_ = 0.0;
  double work_ = 0.0;
  double work_received_ = 0.0;
  double slosh_work_ = 0.0;      // J that what swings gave here
  double slosh_received_ = 0.0;  // of it by the moment of the host's update
  double load_trust_ = 1.0;
  double stored_ = 0.0;
  bool started_ = false;
};

}  // namespace slosh
