// The in-process channel: what passes between one host and one peer, with the messages a network will carry.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "net/snapshot_queue.h"
#include "net/triple_buffer.h"
#include "sim/math/fluid_wrench.h"
#include "sim/snapshot.h"

namespace slosh {

/// Up: where one handle is.
struct PoseMessage {
  std::int64_t stamp_ns = 0;  ///< the peer's steady clock when the device was read
  double time = 0.0;          ///< simulated s that the pose belongs to, by the peer's reckoning
  std::uint32_t device = 0;   ///< index into Scene::grips
  Pose pose;                  ///< handle, world
  Twist twist;                ///< handle, world, m and rad a simulated s: as fast as the world sees it
  bool engaged = false;
  /// The person feels what the hand holds, or is nobody who does. False while their force has not begun,
  /// because the host has not answered yet: one far away keeps its stand until then
  /// (BodyMessage::stands_until_felt).
  bool felt = true;
  bool lost = false;         ///< not engaged because contact was lost: the host lets go gently
  bool stand = false;        ///< engaged, or lost, for the host itself: nobody's hand
  std::uint32_t hold = 0;    ///< another one than in the message before: another hand, which may be anywhere
  std::uint64_t number = 0;  ///< of the sender's samples, rising; comes back in BodyMessage::pose_numbers
  bool counted = false;      ///< somebody counts …
  double energy = 0.0;       ///< … the J that the person and the engagement ramp put in, cumulative
};

/// What a state says of the hand on one grip, besides GripState.
struct HandWord {
  std::uint64_t number = 0;  ///< PoseMessage::number of the reading that the step used; 0 = none
  std::int64_t read_ns =
      0;                 ///< of the reader's own: when that was read, on the reader's clock; 0 = not known
  double time = 0.0;     ///< simulated s that it was said to belong to
  bool counted = false;  ///< PoseMessage::counted
  double energy = 0.0;   ///< J, PoseMessage::energy
  bool stand = false;    ///< PoseMessage::stand
};

/// BodyMessage::heard_pose_ns in one process, where no pose is lost.
constexpr std::int64_t kPoseNotTold = -1;

/// Down, every tick: where the bodies are.
struct BodyMessage {
  /// The host's steady clock at the moment that the state belongs to: when the step was scheduled to end, not
  /// when it happened to be ready. Simulated time against this clock is a straight line while the world keeps
  /// its pace, so that a hand between two states feels no jitter of the steps' durations. May be ahead of
  /// now.
  std::int64_t stamp_ns = 0;
  std::uint32_t run = 0;   ///< rises by one with every reset, when simulated time starts anew
  double rate = 0.0;       ///< simulated seconds a wall second right now, 0 while standing still
  double time_step = 0.0;  ///< s, a tick's length
  /// Simulated s by which a device loop carries the world's time on for its devices until the next state
  /// comes, two ticks at least: over a network a state may be late while the world goes on.
  double carry_on = 0.0;
  /// When the newest of the reader's own poses that this state follows was read, on the reader's clock; 0 =
  /// it follows none yet.
  std::int64_t heard_pose_ns = kPoseNotTold;
  /// The host holds a grip itself until its hand is felt, and the hand takes hold then: PoseMessage::felt
  /// reaches it.
  bool stands_until_felt = false;
  std::vector<std::uint64_t> pose_numbers;  ///< one a grip: PoseMessage::number of what the step used
  BodySnapshot bodies;
  /// Of held bodies that somebody asked for, each body once at most, the newest there are of this run: of
  /// this state in one process; over a network of this one, an older one or one that is not due yet
  /// (FluidWrenchModel::tick).
  std::vector<FluidWrenchModel> fluid_models;
  std::vector<HandWord> hands;  ///< one a grip, or none
};

/// Joins one host and one peer in one process. Poses and body states are newest-value exchanges without a
/// lock; snapshots queue. Each member names the one thread that writes and the one that reads.
class Channel {
 public:
  /// `initial` is what the peer sees before the first step. `snapshot_bytes` bounds the queue of snapshots.
  Channel(std::size_t devices, const BodyMessage& initial, std::size_t snapshot_bytes)
      : bodies_(initial), newest_(initial), snapshots_(snapshot_bytes) {
    poses_.reserve(devices);
    for (std::size_t i = 0; i < devices; ++i) {
      PoseMessage nothing;
      nothing.device = static_cast<std::uint32_t>(i);
      poses_.push_back(std::make_unique<TripleBuffer<PoseMessage>>(nothing));
    }
  }

  std::size_t devices() const { return poses_.size(); }
  TripleBuffer<PoseMessage>& pose(std::size_t device) { return *poses_[device]; }  ///< device loop → host
  TripleBuffer<BodyMessage>& bodies() { return bodies_; }                          ///< host → device loop
  /// Network → device loop: the newest state as soon as it comes, where bodies() are held back until they are
  /// due. Nobody writes it in one process, where bodies() are that.
  TripleBuffer<BodyMessage>& newest() { return newest_; }
  SnapshotQueue& snapshots() { return snapshots_; }  ///< host → viewer

 private:
  std::vector<std::unique_ptr<TripleBuffer<PoseMessage>>> poses_;
  TripleBuffer<BodyMessage> bodies_;
  TripleBuffer<BodyMessage> newest_;
  SnapshotQueue snapshots_;
};

}  // namespace slosh
