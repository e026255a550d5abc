// A world that runs while somebody looks on: in this process, on a host elsewhere, or out of a recording.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "net/snapshot_queue.h"
#include "peer/app/own_hands.h"
#include "peer/output/summary.h"
#include "peer/remote/peer_console.h"
#include "peer/view/hud/hud.h"
#include "peer/view/hud/rates.h"
#include "peer/view/live_panel.h"

namespace slosh {

/// What the film and the window need of a run. Made, started and ended by one thread, which is also the one
/// that calls everything here; snapshots() and rates() may be read by a viewer's thread as well.
class LiveRun {
 public:
  virtual ~LiveRun() = default;

  virtual void start() = 0;
  /// Asks the run to end; running() tells when it has.
  virtual void request_stop() = 0;
  virtual bool running() = 0;
  /// Ends the world's side, then the device loop, then the recording. May be called again.
  virtual void stop() = 0;

  /// Every snapshot in order, for a film; closed when there are no more.
  virtual SnapshotQueue& snapshots() = 0;
  /// What to show now, for a window; null = what is on show already.
  virtual SnapshotPointer newest_snapshot() { return snapshots().pop_newest(); }

  virtual HudFacts facts(double picture_rate) const = 0;
  /// What is known right now; also written to the rate log.
  Rates note_rates();
  RateLog& rates() { return rates_; }

  void pause(bool paused);
  virtual bool paused() const { return false; }
  /// Starts the world again in place, so that the files of the run, its film and its recording go on.
  void start_again();
  /// The key for grips was pressed: take the next free one, or let go of what is held.
  void change_grip();
  /// Whether lines may be typed at this run (hear()).
  virtual bool hears() const { return false; }
  /// One line that was typed, to its answer; may be empty.
  std::string hear(const std::string& line);

  /// Where the mouse moves the handle of grip `i`; null when that hand is no mouse.
  MouseTarget* mouse_target(std::size_t i) { return hands() ? hands()->mouse_target(i) : nullptr; }
  /// The hand of grip `i` where a script holds it that the window may take over; else null.
  SharedHandle* lent_hand(std::size_t i) { return hands() ? hands()->lent(i) : nullptr; }
  /// The camera turned (Device::look_from).
  void look_from(const glm::dquat& axes) {
    if (hands()) hands()->servo().look_from(axes);
  }

  /// What may be changed while it runs, as it is.
  virtual LiveValues live_values() const { return {}; }
  /// Asks for one of these; what is refused is in take_notices().
  virtual void change(const LiveWish& wish);
  /// So many steps of a world that stands, where LiveValues::may_pace.
  virtual void step_standing(int steps) { (void)steps; }
  /// Lines about what was done and what was not granted since the last call, where nobody else tells the
  /// person.
  virtual std::vector<std::string> take_notices() { return {}; }

  /// Pa, one a particle, as new as they are at hand, where the world is in this process; null else and before
  /// there are any. `wanted`: they are looked at from now on.
  virtual std::shared_ptr<const std::vector<float>> pressures(bool wanted) {
    (void)wanted;
    return nullptr;
  }

  /// What has gone wrong with the run's files and devices so far, e.g. that the disk is full; empty while
  /// nothing has.
  virtual std::string trouble() const { return hands() ? hands()->trouble({}) : std::string(); }

  /// Frames for other programs that wait to be written; stop() writes them.
  virtual std::size_t exports_waiting() const { return 0; }

  /// Fills what the run knows; after stop().
  virtual void report(RunSummary& summary) const = 0;

 private:
  /// The hands here; null where there are none: in a recording.
  virtual OwnHands* hands() const { return nullptr; }
  /// What note_rates() is to say of the world.
  virtual Rates world_rates() = 0;
  /// What a typed line asks for.
  virtual PeerLine understand(const std::string& line) { return {line, {}, false}; }
  /// Asks the world for it. What is refused is in take_notices(); of what was `typed` it is said there, too,
  /// that it was done.
  virtual void ask(const RemoteCommand& command, bool typed) { (void)command, (void)typed; }

  RateLog rates_;
};

}  // namespace slosh
