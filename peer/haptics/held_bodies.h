// The bodies that hands of this site hold, between body states as they are received and the device loop.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "net/channel.h"
#include "peer/replica/held_body.h"
#include "scenes/scene.h"

namespace slosh {

/// What a hand that gives way to the force is coupled to.
enum class Coupling {
  kReplica,  ///< this site's replica of the body (peer/replica)
  kSpring,   ///< the host's body as it comes: steady over short links only
};

/// A HeldBody for each free body with grips. How far its replica counts goes by the delay of this site's
/// loop: where host and hand are in one process, or a few milliseconds apart, the host's own body is as new
/// and is used as it is. In one process with a model of the fluid's wrench on it the replica is used all the
/// same: it has the fluid at 1 kHz, however slow the world's steps are. A body that no device here moves is
/// not followed, and what swings in one is looked for only where a device gives way to the force. One thread,
/// the device loop's; neither allocates nor locks once made.
class HeldBodies {
 public:
  /// `scene` must outlive it.
  HeldBodies(const Scene& scene, Coupling coupling);

  /// s of round trip and jitter up to which the host's body is used, and from which the replica is.
  static constexpr double kNear = 0.005;
  static constexpr double kFar = 0.02;

  /// Once a tick: the newest state and whether it came since the tick before.
  void update(const BodyMessage& newest, bool fresh, std::int64_t now_ns) noexcept;

  /// Whether the body of grip `i` was restarted in the last update(): its hands re-engage.
  bool anew(std::size_t i) const noexcept;
  /// The device of grip `i` was read here, and at the reading before there.
  void read(std::size_t i, const Pose& before, const Pose& now) noexcept;
  /// After all were read, before grip(): a loop that missed ticks brings the replicas to `now_ns`, with each
  /// hand evenly from where it was to where it is: against a replica that stood meanwhile it would be far
  /// ahead of it. `period`: of ticks, s; `pace` and `elapsed` as in advance().
  void catch_up(std::int64_t now_ns, double period, double pace, double elapsed) noexcept;
  /// Where the coupling of grip `i` goes to, of what it is at the host, carried on to now.
  GripState grip(std::size_t i, const GripState& at_host) const noexcept;
  /// In place of the coupling's `wanted` (HeldBody::limit).
  Wrench guard(std::size_t i, const Wrench& wanted, const Pose& hand, const Twist& twist, double dt,
               double most_damping, double pace) noexcept;
  /// What the device of grip `i` was sent, and the hand as its coupling used it, by the world's time;
  /// `ramp_work`: J that its engagement ramp gave (ForceRendering::ramp_work). `with_world`: the hand itself
  /// goes by that (Device::goes_with_world).
  void sent(std::size_t i, const Wrench& wrench, const OwnHand& hand, double ramp_work,
            bool with_world) noexcept;
  /// The coupling of grip `i` is that from now on, at the host and here.
  void set_gains(std::size_t i, const CouplingGains& gains) noexcept;
  /// Nobody here moves grip `i`.
  void not_here(std::size_t i) noexcept;
  /// The end of a tick: on to `now_ns`. A replica goes by the time that its hands go by: the wall's times
  /// `pace`, simulated s a s, smoothed; or, where all go with the world, by the `elapsed` simulated s that
  /// they were told of in this tick.
  void advance(std::int64_t now_ns, double pace, double elapsed) noexcept;

  /// J that the person at grip `i` and its hold put in; false where that is not counted: a fixed body.
  bool counted(std::size_t i) const noexcept { return places_[i].body >= 0; }
  double energy(std::size_t i) const noexcept;
  /// 0 = the host's body is used, 1 = the replica.
  double share(std::size_t i) const noexcept;
  LoopDelay delay(std::size_t i) const noexcept;
  /// The body of grip `i`; null for one that is fixed.
  const HeldBody* held(std::size_t i) const noexcept {
    const int body = places_[i].body;
    return body < 0 ? nullptr : &bodies_[static_cast<std::size_t>(body)].held;
  }

 private:
  struct Place {
    int body = -1;         // in bodies_
    std::size_t grip = 0;  // of that body's
  };
  struct Entry {
    std::size_t body = 0;            // in the scene
    std::vector<std::size_t> grips;  // in the scene
    HeldBody held;
    std::vector<OwnHand> own;
    std::vector<MotionError> way;  // of own hands' devices since the tick before
    std::vector<HostHand> said;
    double share = 0.0;
    bool on_the_wall = false;  // one of its hands goes by the wall's clock
    bool anew = false;
    MassProperties mass;           // of what is left of it
    std::uint64_t model_tick = 0;  // of the newest model; 0 = none came
  };
  static void restart(Entry& entry) noexcept;
  void follow_cuts(Entry& entry, const BodyCuts* cuts) noexcept;
  void tell(Entry& entry, const BodyMessage& newest, std::int64_t now_ns) noexcept;

  const Scene& scene_;
  Coupling coupling_;
  std::vector<Place> places_;  // one a grip of the scene
  std::deque<Entry> bodies_;
  std::uint32_t run_ = 0;
  double rate_ = 0.0;
  double interval_ = 0.0;  // s between updates
  bool here_ = true;       // the host is in this process
  std::int64_t received_ns_ = 0;
  std::int64_t advanced_ns_ = 0;
  double caught_up_ = 0.0;  // simulated s of this tick that were caught up with
  bool began_ = false;      // replicas did, with this tick's update
};

}  // namespace slosh
