// A body that hands of this site hold, wherever the host is: its replica, what acts on it by the host's
// updates, a passivity controller for each hand, and what they fall back on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "peer/devices/velocity_window.h"
#include "peer/replica/body_replica.h"
#include "peer/replica/energy_balance.h"
#include "peer/replica/fallback.h"
#include "peer/replica/host_update.h"
#include "peer/replica/load_estimator.h"
#include "peer/replica/load_work.h"
#include "peer/replica/passivity_controller.h"

namespace slosh {

/// One own hand in one tick.
struct OwnHand {
  bool here = false;  ///< a device of this site moves the grip
  bool engaged = false;
  Pose handle{};       ///< as the coupling uses it (net/engagement.h)
  Twist twist{};       ///< by the body's time
  bool feels = false;  ///< it gives way to the force (Device::gives_way)
};

/// From `a` (share 0) to `b` (1), what is not a motion as `a` has it.
inline GripState between(const GripState& a, const GripState& b, double share) {
  GripState mixed = a;
  mixed.pose.position += share * (b.pose.position - a.pose.position);
  mixed.pose.orientation =
      rotate_by(a.pose.orientation, share * rotation_between(a.pose.orientation, b.pose.orientation));
  mixed.twist.linear += share * (b.twist.linear - a.twist.linear);
  mixed.twist.angular += share * (b.twist.angular - a.twist.angular);
  return mixed;
}

/// A tick is: receive() what came; for each own hand grip(), the coupling to it, limit(), sent(); then
/// advance(). Reads no clock, neither allocates nor locks once made; one thread.
class HeldBody {
 public:
  HeldBody(const ReplicaBody& body, std::vector<ReplicaGrip> grips, const ReplicaTuning& tuning = {});

  /// The next update is taken as it is: at first, after a reset, a pause, a silence.
  void restart() noexcept;
  bool started() const noexcept { return started_; }
  /// It has another mass from now on, as a part that was cut off; restart() follows.
  void become(const ReplicaBody& body) noexcept;
  void receive(const HostUpdate& word) noexcept;
  /// How the fluid answers to the body, before receive() of the same state or a newer one: its derivatives,
  /// its added mass and the trust in them count. What acts besides them is worked out from how the body
  /// moves.
  void set_fluid(const FluidLoad& model) noexcept { load_.fluid = made_safe(model); }

  /// Where an own hand's coupling goes to, at the moment of the last advance().
  GripState grip(std::size_t g) const noexcept;
  /// The wrench for own hand `g` in place of its coupling's `wanted`: damped for the delay, and so that no
  /// more comes out of this site than went in. `hand`: as it is read; its `twist`, `dt` and `most_damping`
  /// (N·s/m that the device holds) by the device's own time, of which a second is `pace` s of the body's.
  Wrench limit(std::size_t g, const Wrench& wanted, const Pose& hand, const Twist& twist, double dt,
               double most_damping, double pace = 1.0) noexcept;
  /// Grip `g`'s coupling is that from now on, here as at the host.
  void set_gains(std::size_t g, const CouplingGains& gains) noexcept {
    gains_[g] = gains;
    replica_.set_gains(g, gains);
  }
  /// What own hand `g` was sent, and J that its coupling was given besides the hand's motion.
  void sent(std::size_t g, const Wrench& wrench, double ramp_work = 0.0) noexcept {
    controllers_[g].sent(wrench, ramp_work);
  }
  /// On by `dt` s of the body's time, to `now_ns`.
  void advance(std::span<const OwnHand> own, double dt, std::int64_t now_ns) noexcept;

  /// J that the person at own grip `g` and the hold put in.
  double energy(std::size_t g) const noexcept { return controllers_[g].energy(); }
  /// J that may still come out at the own hands: what all persons put in and what acts besides gave the body
  /// at the host, less what dampers used up.
  double balance() const noexcept;
  LoopDelay delay() const noexcept { return delay_.delay(); }  ///< by the clock on the wall
  const BodyReplica& replica() const noexcept { return replica_; }
  const SloshFinder& slosh(std::size_t axis) const noexcept { return load_.carried.finder(axis); }
  /// The passivity controllers fired so often that a damped spring to the host's update replaces the replica.
  bool fallen_back() const noexcept { return fallback_.fallen_back; }
  std::uint64_t fired() const noexcept { return fallback_.fired; }  ///< ticks in which a controller did

 private:
  void begin_count(const HostUpdate& word) noexcept;
  /// Where the damped spring goes to.
  GripState late_grip(std::size_t g) const noexcept;
  ReplicaBody body_;
  BodyReplica replica_;
  std::vector<Pose> grips_;  // in the mesh frame
  std::vector<CouplingGains> gains_;
  std::vector<ReplicaHand> hands_;
  std::vector<VelocityWindow> speeds_;            // of other sites' hands
  std::vector<PassivityController> controllers_;  // of own ones
  LoopDelayEstimate delay_;
  RigidMotion received_;
  double received_time_ = 0.0;
  bool counted_ = false;  // all who hold the body
  std::int64_t received_ns_ = 0;
  double pace_ = 1.0;            // HostUpdate::pace
  double since_received_ = 0.0;  // s
  double ahead_ = 0.0;  // s until the moment of the update, when it came: a slow host's is of a step's end
  bool started_ = false;
  LoadWork load_work_;
  LoadEstimator load_;
  EnergyBalance energy_;
  Fallback fallback_;
  std::vector<Pose> used_;  // own hands as the host used them, of the newest update; where none was
                            // engaged, the grip
  double step_ = 0.0;       // s of the host's step
};

}  // namespace slosh
