// What a peer remembers of the last moments, and the world at any time between them.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "net/channel.h"
#include "net/codec/snapshot_codec.h"
#include "net/snapshot_queue.h"

namespace slosh {

/// The world between two moments of each kind. Cheap to copy, so that the blending can be done without a
/// lock.
struct Between {
  std::shared_ptr<const DecodedFrame> before;  ///< null: no particles yet
  std::shared_ptr<const DecodedFrame> after;   ///< of the same epoch as `before`, or `before` itself
  double share = 0.0;                          ///< of `after`, 0–1
  BodySnapshot rigid;                          ///< bodies and grips at `time`, and the time itself
};

/// Particles move in straight lines between the two frames. One that has left the world in either is not
/// drawn.
std::shared_ptr<Snapshot> blend(const Between& between);

/// Bodies and grips at `time`, between a.time and b.time: positions, velocities and forces along straight
/// lines, turns by the shorter way at an even speed.
BodySnapshot blend(const BodySnapshot& a, const BodySnapshot& b, double time);

/// The last frames and body states of one run of the world. One thread, or one lock.
class SnapshotHistory {
 public:
  /// Frames come as SnapshotDecoder gives them: in order, the one that begins an epoch twice, in the old
  /// order and in the new. A higher run forgets what was; of a lower one nothing is taken.
  void add(DecodedFrame frame);
  /// States come in order of time.
  void add(std::uint32_t run, const BodySnapshot& bodies);
  /// Where another person's hand was at `time`, simulated s. In order of time; one that is not engaged is
  /// nowhere to be seen. Told of a run that is not the present one, it is left out.
  void add_hand(std::uint32_t run, std::size_t grip, double time, const Pose& pose, bool engaged);
  /// A new connection: any run may follow.
  void restart();

  /// The world at `time` (simulated s): between the two frames around it when both are of one epoch, else as
  /// the last frame before it has the particles, or the first after; the same for bodies. A hand that was
  /// told of is where it is itself, not where its grip's coupling has it. Null when there is nothing at all.
  std::optional<Between> at(double time) const;
  /// Nothing before `time` will be asked for.
  void forget_before(double time);

  std::uint32_t run() const { return run_; }
  bool has_frames() const { return !frames_.empty(); }
  bool has_bodies() const { return !bodies_.empty(); }
  double first_frame_time() const { return frames_.front()->time; }
  double last_frame_time() const { return frames_.back()->time; }
  double last_body_time() const { return bodies_.back().time; }
  double first_body_time() const { return bodies_.front().time; }

 private:
  void follow_run(std::uint32_t run);
  void bound();
  void place_hands(BodySnapshot& rigid) const;
  struct HandSample {
    double time = 0.0;
    Pose pose;
    bool engaged = false;
  };

  std::deque<std::shared_ptr<const DecodedFrame>> frames_;  // by time
  std::deque<BodySnapshot> bodies_;                         // by time
  std::vector<std::deque<HandSample>> hands_;               // one a grip, by time
  std::uint32_t run_ = 0;
  bool any_run_ = true;
  std::size_t bytes_ = 0;  // of frames_
};

}  // namespace slosh
