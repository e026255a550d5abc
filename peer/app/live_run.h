// A world that runs while somebody looks on: in this process, or on a host elsewhere.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "net/snapshot_queue.h"
#include "peer/haptics/mouse_device.h"
#include "peer/haptics/shared_handle.h"
#include "peer/output/summary.h"
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
  virtual SnapshotPointer newest_snapshot() = 0;

  virtual HudFacts facts(double picture_rate) const = 0;
  /// What is known right now; also written to the rate log.
  virtual Rates note_rates() = 0;
  virtual RateLog& rates() = 0;

  virtual void pause(bool paused) = 0;
  virtual bool paused() const = 0;
  /// Starts the world again where that can be done in place. False: end this run and make another.
  virtual bool start_again() { return false; }
  /// The key for grips was pressed: take the next free one, or let go of what is held.
  virtual void change_grip() {}
  /// Whether lines may be typed at this run (hear()).
  virtual bool hears() const { return false; }
  /// One line that was typed, to its answer; may be empty.
  virtual std::string hear(const std::string& line) { return line; }
  /// Where the mouse moves the handle of grip `i`; null when that hand is no mouse.
  virtual MouseTarget* mouse_target(std::size_t i) = 0;
  /// The hand of grip `i` where a script holds it that the window may take over; else null.
  virtual SharedHandle* lent_hand(std::size_t i) {
    (void)i;
    return nullptr;
  }

  /// What may be changed while it runs, as it is.
  virtual LiveValues live_values() const { return {}; }
  /// Asks for one of these; what is refused is in take_notices().
  virtual void change(const LiveWish& wish) { (void)wish; }
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

  /// The camera turned (Device::look_from).
  virtual void look_from(const glm::dquat& axes) { (void)axes; }

  /// What has gone wrong with the run's files and devices so far, e.g. that the disk is full; empty while
  /// nothing has.
  virtual std::string trouble() const { return {}; }

  /// Frames for other programs that wait to be written; stop() writes them.
  virtual std::size_t exports_waiting() const { return 0; }

  /// Fills what the run knows; after stop().
  virtual void report(RunSummary& summary) const = 0;
};

}  // namespace slosh
