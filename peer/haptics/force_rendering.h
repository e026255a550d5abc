// Force rendering for one hand: the coupling to its grip, and nothing that only the link or a pause would
// add.
#pragma once

#include <algorithm>

#include "net/engagement.h"
#include "peer/haptics/device.h"
#include "peer/haptics/force_limiter.h"
#include "peer/haptics/freshness.h"
#include "peer/haptics/link_freshness.h"
#include "sim/math/coupling.h"
#include "sim/snapshot.h"

namespace slosh {

/// One rule for silence, pauses and resets, of the world and of the device: the force never jumps, and never
/// grows by them.
///  - While updates are late the force is at most what it was with the last that was in time, and it fades
///    by freshness().
///  - A hand that re-engages goes on feeling as much of it as it felt still.
///  - A hand that had no force gets it over DeviceLimits::engagement_time: with a new device, after a pause,
///    a reset or a silence, when it re-engages, when it suddenly is elsewhere. A silence that took a
///    part of the force takes as large a part of that time. Meanwhile its own motion is damped. Where nobody
///    feels it, what a silence took comes back over kFadeStale.
///  - No force begins before world and device are both fresh. A hand that feels none begins with all of it.
///    A host that keeps its stand until then is told by felt(), and the hand engages where it is by then.
///  - Where the force would jump all the same, because the hand's hold is another one, the difference is
///    worked off over kBridge; where the world was reset, over kFadeStale, which an arm can follow.
/// A hand that gives way to the force (Device::gives_way) feels the coupling as this end has it, so that its
/// own newest motion acts at once. Any other feels what the world put on it (GripState::on_hand): there hand
/// and grip are compared at one time. Here they are not, as the grip's newest velocity answers a handle of
/// one or two steps ago: a stiff coupling would add its damping times what the hand gained in speed since.
/// Pure; one thread; no allocation.
class ForceRendering {
 public:
  explicit ForceRendering(const CouplingGains& of_world) : gains_(of_world), of_world_(of_world) {}

  /// Another device: its limits, and no hold yet. `of_world`: the coupling as the world has it, by which the
  /// hand engages, here as there; it is felt within the limits.
  void restart(const CouplingGains& of_world, const DeviceLimits& limits, bool gives_way) {
    *this = ForceRendering(of_world);
    gains_ = within(of_world, limits);
    limiter_ = ForceLimiter(limits);
    gives_way_ = gives_way;
    most_damping_ = limits.max_damping;
    most_turning_ = limits.max_rotational_damping;
    if (!gives_way || limits.engagement_time <= 0.0) return;
    rise_ = limits.engagement_time;
    gentle_ = true;
    share_ = 0.0;
    damping_ = 0.5 * std::min(limits.max_damping, kMaxRampDamping);
    rotational_damping_ = 0.5 * std::min(limits.max_rotational_damping, kMaxRampTurning);
  }

  /// The world's coupling as it is from now on; the hold stays.
  void set_gains(const CouplingGains& of_world, const DeviceLimits& limits) noexcept {
    of_world_ = of_world;
    gains_ = within(of_world, limits);
  }

  /// Nobody called feel() for so long that the device has only that share (0–1) of its wrench left: what
  /// comes back begins there.
  void faded(double share) noexcept {
    limiter_.faded(share);
    last_ = {share * last_.force, share * last_.torque};
  }

  struct Moment {
    double time = 0.0;          ///< simulated s, never falling but when the world was reset
    double period = 0.001;      ///< s since the call before
    double device_share = 1.0;  ///< freshness of the device's own readings
    bool leapt = false;         ///< the hand is suddenly elsewhere (net/leap.h)
    bool shared = false;        ///< another hand holds the same body
    bool stands = false;        ///< BodyMessage::stands_until_felt
    double pace = 1.0;          ///< simulated s a s of the device's own time, > 0
  };
  /// The wrench for the device. `hand` as the device has it, its velocities by the device's own time; `grip`
  /// as the world has it, carried on to `now.time`. Where the world is slower (`now.pace`), the coupling is
  /// the world's, with the hand as fast as the world sees it, and damps no harder than the device holds.
  ForceLimiter::Outcome feel(const StateFreshness& world, const DeviceReport& hand, const GripState& grip,
                             const Moment& now) noexcept {
    return feel(world, hand, grip, now, [](const Wrench& wanted) { return wanted; });
  }
  /// The same, with `guard` called once with the coupling's wrench; what it gives is capped, faded and
  /// limited in its place.
  template <class Guard>
  ForceLimiter::Outcome feel(const StateFreshness& world, const DeviceReport& hand, const GripState& grip,
                             const Moment& now, Guard&& guard) noexcept {
    const Wrench wanted = couple(world, hand, grip, now);
    return finish(guard(wanted), hand.twist, now);
  }

  /// The hand as its coupling used it in the last feel(), and whether it held on.
  const Engagement::Held& held() const { return held_; }
  bool holds() const { return engagement_.engaged(); }
  /// J that the last feel() gave the world's coupling by the engagement ramp, towards a hand that stays; less
  /// than 0 where it slipped: it is no motion of the hand's, but a body is lifted by it all the same.
  double ramp_work() const { return engagement_.given(); }

  /// Whether what the hand does is felt by its person, as of the last feel(): their force has begun and no
  /// silence has taken it, or there is nobody who would feel it (PoseMessage::felt).
  bool felt() const { return felt_; }

  /// Whether this hand felt, or would have felt but for a silence, just what the world put on it. As of the
  /// last feel(); false for a hand that gives way, one that does not hold on, and where a limit acted.
  bool follows_world() const { return follows_world_; }

  /// N·s/m and N·m·s/rad, twice the most that damps a hand that is about to get force.
  static constexpr double kMaxRampDamping = 10.0;
  static constexpr double kMaxRampTurning = 0.02;
  /// s over which a jump is worked off: 15 N on a hand are released at 150 N/s.
  static constexpr double kBridge = 0.1;

 private:
  Wrench couple(const StateFreshness& world, const DeviceReport& hand, const GripState& grip,
                const Moment& now) noexcept;
  ForceLimiter::Outcome finish(Wrench wanted, const Twist& twist, const Moment& now) noexcept;
  Wrench capped(const Wrench& full, bool current) noexcept;
  Wrench ramped(const Wrench& full) const noexcept;
  double shaped_share() const noexcept;

  CouplingGains gains_;                   // as it is felt
  CouplingGains of_world_;                // as the hold goes by it
  ForceLimiter limiter_{DeviceLimits{}};  // gives nothing before restart()
  Engagement engagement_;
  Engagement::Held held_;
  bool jumps_ = false;  // in this call
  bool gives_way_ = true;
  bool follows_world_ = false;
  bool gentle_ = false;       // a hand feels it
  double rise_ = kFadeStale;  // s from no force to all of it
  double damping_ = 0.0;      // of a hand that gets it
  double rotational_damping_ = 0.0;
  double most_damping_ = 0.0;  // N·s/m and N·m·s/rad that the device holds
  double most_turning_ = 0.0;
  double share_ = 1.0;
  double kept_force_ = 0.0;   // N and
  double kept_torque_ = 0.0;  // N·m that the hand felt when it re-engaged
  double fresh_ = 1.0;        // share of freshness at the call before
  bool begun_ = false;  // world and device were both fresh since the device came, or the world was reset
  bool felt_ = false;
  bool hold_anew_ = false;   // updates had stopped
  bool held_on_ = false;     // the hand, at the call before
  bool current_ = true;      // the world was, at the call before
  double most_force_ = 0.0;  // N, with the last state that was in time
  double most_torque_ = 0.0;
  Wrench last_;            // of the call before
  Wrench bridge_;          // what is left of a jump,
  double left_ = 0.0;      // the share of it, 0–1,
  double over_ = kBridge;  // and s over which it goes
};

}  // namespace slosh
