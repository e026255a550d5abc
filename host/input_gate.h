// From the poses that peers send to the inputs that a step takes: checked, ramped, in a fixed order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/pose_fault.h"
#include "net/channel.h"
#include "net/clock.h"
#include "net/engagement.h"
#include "scenes/scene.h"
#include "sim/math/coupling.h"
#include "sim/world.h"

namespace slosh {

/// s of simulated time over which a coupling fades whose hand was lost (PoseMessage::lost).
constexpr double kLostFade = 0.4;
/// The same where somebody else holds the body too, who gets its weight from it: as long as a hand is let
/// feel what it engages (net/engagement.h). In 0.4 s a load that doubles lets the other arm drop.
constexpr double kHandOver = 2.0;
/// s of wall time without a message after which a hand is taken to come to rest: a twist as old as that would
/// drag the body along ...
constexpr double kStaleTwist = 0.015;
/// ... and the time constant of that, s of simulated time.
constexpr double kRunOut = 0.1;
/// A hand without updates for this long, s of wall time, gives way where another person's hand on the body is
/// not silent (Company::kSilent). So whoever is left carries their own share, and does not pull against a
/// hand that hangs in the air.
constexpr double kYieldAfter = 0.02;
/// s of wall time after a reset in which messages of the run before may still come.
constexpr double kOldRun = 1.0;

/// Takes each device's newest message at a step's boundary, device 0 first. A pose that fails a check is not
/// used: the last good one stays, standing still. Owned by the host's thread.
class InputGate {
 public:
  explicit InputGate(const Scene& scene);

  /// The inputs for the step that follows `now`, one a grip. `clock_ns` is the steady clock. The result is
  /// valid until the next call.
  std::span<const HandleInput> take(Channel& channel, const BodySnapshot& now,
                                    std::int64_t clock_ns = steady_now_ns());

  /// Takes in one message; false (and the fault kept in last_fault()) when it is not used.
  bool accept(const PoseMessage& message, std::int64_t clock_ns = steady_now_ns());

  /// The world went back to its start, as `now` has it: hands that hold on hold there until they report
  /// anew, and what grips that nobody holds carried in a settled start is given over within kHandOver.
  void reset(const BodySnapshot& now, std::int64_t clock_ns);

  /// The world stood still for a while, and hands may have moved: who holds on re-engages. So does a hand
  /// without updates for kHoldAnew s of wall time (net/engagement.h), when its updates come again.
  void stood_still();

  /// The newest message of each grip that was used; valid until the next call of anything here.
  std::span<const PoseMessage> poses() const { return used_; }

  std::uint64_t rejected() const { return rejected_; }
  /// What take() just refused, kNone or a fault for each grip.
  std::span<const PoseFault> refused() const { return refused_; }
  PoseFault last_fault() const { return last_fault_; }

 private:
  struct Hand {
    int body = 0;
    CouplingGains gains;  // the scene's
    Engagement engagement;
    PoseMessage good;
    bool has_good = false;
    std::int64_t received_ns = 0;  // when `good` came
    bool anew = false;             // the next message is the first since a reset
    bool silent = false;           // none came for long
    double scale = 0.0;            // of the last step
    double lost_at = 0.0;          // simulated s
    double lost_scale = 0.0;       // what is left to fade; 0 = nothing
    double lost_fade = kLostFade;  // s, simulated, over which it does
    Pose last_pose;                // of the hand, in the last step that it was engaged for,
    Pose last_held;                // and where it held
  };
  void fill_input(Hand& hand, std::size_t grip, const BodySnapshot& now, std::int64_t clock_ns);
  void begin_fade(Hand& hand, double scale, double seconds) const;
  double left_to_fade(const Hand& hand) const;
  void note_interval(std::int64_t clock_ns);
  Company company(const Hand& hand, std::int64_t clock_ns) const;
  PoseFault check(const PoseMessage& message, const Hand& hand) const;

  glm::dvec3 reach_min_;
  glm::dvec3 reach_max_;
  std::vector<Hand> hands_;
  std::vector<HandleInput> inputs_;
  std::vector<PoseMessage> used_;
  std::vector<PoseFault> refused_;     // by the last take()
  double time_ = 0.0;                  // simulated s of the last step
  double step_ = 0.0;                  // s from the one before to that
  std::int64_t taken_ns_ = 0;          // when it was taken
  double usual_interval_ = 0.0;        // s of wall time between steps
  std::int64_t old_run_until_ns_ = 0;  // messages of the run before may come until then
  std::uint64_t rejected_ = 0;
  PoseFault last_fault_ = PoseFault::kNone;
};

}  // namespace slosh
