// Body states as they come off the wire → body states as a device loop wants them: whole, in order, and on
// the peer's own clock.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "net/channel.h"
#include "net/wire/cuts.h"
#include "net/wire/fluid_wrench.h"
#include "net/wire/messages.h"
#include "peer/remote/adaptive_delay.h"
#include "peer/remote/clock_sync.h"
#include "scenes/scene.h"

namespace slosh {

struct BodyInboxCounts {
  std::uint64_t parts = 0;       ///< taken
  std::uint64_t states = 0;      ///< given out
  std::uint64_t incomplete = 0;  ///< given out with a part missing
  std::uint64_t late = 0;        ///< parts of a state older than what was given out, or twice the same
  std::uint64_t wrong = 0;       ///< parts that name a body or grip that the scene has not, models likewise
  std::uint64_t models = 0;      ///< of fluid wrenches, taken
};

/// Where the host's simulated time stands: the straight line through its newest state.
struct WorldMoment {
  std::uint32_t run = 0;
  double time = 0.0;          ///< simulated s at stamp_ns
  std::int64_t stamp_ns = 0;  ///< the host's clock
  double rate = 0.0;          ///< simulated s a s
  bool known = false;

  /// Simulated s at `host_ns`, carried on for half a second at most.
  double time_at(std::int64_t host_ns) const;
};

/// Tells what waited somewhere from what is slow. When a link stands still for more than kHoldAnew and then
/// delivers all that it kept, each of it is less late than the one before, faster than time goes: that says
/// how long it stood, not how late things come. One thread.
class Backlog {
 public:
  /// One arrival, s late; true when it was kept back.
  bool holds(double lateness, double usual, std::int64_t now_ns);
  void restart() { *this = Backlog{}; }

 private:
  std::int64_t last_ns_ = 0;  // the arrival before
  bool draining_ = false;
  std::int64_t mark_ns_ = 0;
  double mark_ = 0.0;  // lateness then, s
};

/// A state is handed on when it is due: at its stamp, mapped to the peer's clock, plus a delay that follows
/// how late states come (AdaptiveDelay). So a device loop, which carries states on by at most two ticks,
/// lives a constant small time behind the host, whatever the distance and the jitter. Reads no clock; one
/// thread.
class BodyInbox {
 public:
  /// `scene` must outlive it. `time_step` in s, > 0.
  BodyInbox(const Scene& scene, double time_step);

  /// A new connection: any run and tick may follow. Bodies stay where they are until then.
  void restart();

  /// `now_ns`: the peer's clock when it came.
  void take(const wire::Bodies& part, std::int64_t now_ns, const ClockSync& clock);

  /// Joins the next state that is given out.
  void take(const wire::FluidWrench& model);

  /// They hold from their tick on; what comes late, from the next state on.
  void take(const wire::Cuts& cuts);

  /// The world stands still, as the host said: the last state is handed out once more with a pace of 0.
  void set_paused(bool paused) { paused_ = paused; }

  /// What this host's states say of its stands (BodyMessage::stands_until_felt), from the next one on.
  void set_stands_until_felt(bool stands) { state_.stands_until_felt = newest_.stands_until_felt = stands; }

  /// The newest state that is due, made whole, or null when there is nothing new. The state of a world that
  /// stands still is given out again whenever the host says it again: a device loop must know that somebody
  /// does. Valid until the next call.
  const BodyMessage* next(std::int64_t now_ns, const ClockSync& clock);
  /// When to call next() again; far away when nothing waits.
  std::int64_t next_due_ns(const ClockSync& clock) const;

  /// The newest state that is whole, as soon as it came: on the peer's clock and nothing added; null when
  /// there is nothing newer than what the call before gave. HandWord::read_ns is not filled in. Valid until
  /// the next take().
  const BodyMessage* newest();

  /// What the scene says before anything came, or the last state given out.
  const BodyMessage& state() const { return state_; }
  bool started() const { return started_; }  ///< a whole state came
  const WorldMoment& moment() const { return moment_; }
  double delay() const { return delay_.value(); }  ///< s behind the host
  const BodyInboxCounts& counts() const { return counts_; }

 private:
  struct Pending {
    std::uint32_t run = 0;
    std::uint64_t tick = 0;
    double time = 0.0;
    std::int64_t stamp_ns = 0;
    double rate = 0.0;
    std::uint32_t status = 0;
    std::int64_t heard_pose_ns = 0;
    std::uint32_t parts = 1;
    std::bitset<256> received;
    std::vector<wire::BodyEntry> bodies;
    std::vector<wire::GripEntry> grips;
    bool complete() const { return received.count() >= parts; }
  };
  bool sound(const wire::Bodies& part) const;
  std::int64_t due_ns(const Pending& pending, const ClockSync& clock) const;
  void apply(const Pending& pending, const ClockSync& clock);
  void lay_out(const Pending& pending, BodyMessage& state) const;
  void place_grips(BodySnapshot& bodies) const;

  const Scene& scene_;
  double time_step_;
  BodyMessage state_;
  BodyMessage newest_;
  bool newest_fresh_ = false;
  std::uint64_t newest_tick_ = 0;
  std::vector<Pending> pending_;  // by tick, of one run
  struct RunCuts {
    std::uint32_t run;
    std::shared_ptr<const BodyCuts> cuts;
  };
  std::vector<RunCuts> cuts_;     // as they came
  std::uint32_t models_run_ = 0;  // that state_.fluid_models are of
  AdaptiveDelay delay_;
  Backlog backlog_;
  WorldMoment moment_;
  BodyInboxCounts counts_;
  std::int64_t advanced_ns_ = 0;
  double interval_ = 0.0;  // simulated s between states, smoothed
  std::uint64_t given_tick_ = 0;
  bool given_ = false;  // given_tick_ and the run hold
  bool started_ = false;
  bool paused_ = false;
  bool pause_told_ = false;
  bool stands_on_ = false;  // the state given out last was said again, standing still
};

}  // namespace slosh
