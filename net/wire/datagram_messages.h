// Messages of one datagram each, field by field: hands, bodies, clocks, what came of the particles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "net/channel.h"
#include "net/wire/capabilities.h"
#include "net/wire/fields.h"
#include "net/wire/limits.h"

namespace slosh::wire {

template <class V>
void visit(V& v, Pose& m) {
  v.vec3("position", m.position, kMaxPosition);
  v.rotation("orientation", m.orientation);
}
template <class V>
void visit(V& v, Twist& m) {
  v.vec3("linear", m.linear, kMaxSpeed);
  v.vec3("angular", m.angular, kMaxSpeed);
}
template <class V>
void visit(V& v, Wrench& m) {
  v.vec3("force", m.force, kMaxForce);
  v.vec3("torque", m.torque, kMaxForce);
}

enum class DatagramType : std::uint8_t {
  // peer → host
  kPoses = 1,
  kClockPing = 2,
  kSnapshotFeedback = 3,
  // host → peer
  kClockPong = 16,
  kBodies = 17,
  kHands = 18,
  kSnapshotPiece = 19,  ///< net/codec has its layout
  kFluidWrench = 20,    ///< fluid_wrench.h; behind kFluidWrenches
};

/// Whether a hand holds on.
enum class HoldsOn : std::uint8_t {
  kNo,
  kYes,
  kUnfelt,  ///< it does, and its person's force has not begun: it moves nothing yet; where kFeltHands is
            ///< agreed
};
constexpr std::array kHoldsOnNames{"no", "yes", "yes, but not felt yet"};

/// One reading of one device.
struct PoseSample {
  std::uint32_t grip = 0;
  std::uint64_t number = 0;   ///< of this grip's samples, rising by one; repeats have the same number
  std::int64_t stamp_ns = 0;  ///< the peer's steady clock when the device was read
  double time = 0.0;          ///< simulated s that it belongs to
  Pose pose;
  Twist twist;
  HoldsOn engaged = HoldsOn::kNo;
  // Behind kCouplings: J that the person and the engagement ramp (engagement.h) put in since this hand began,
  // cumulative, so that a loss spoils nothing.
  double energy = 0.0;
};
template <class V>
void visit(V& v, PoseSample& m) {
  v.natural("grip", m.grip, 0, kMaxGrips - 1);
  v.natural("number", m.number, 0, kMaxTick);
  v.stamp("stamp_ns", m.stamp_ns);
  if (!v.agreed(kNoTickAcks)) {
    std::uint64_t unread = 0;  // the newest body state that an older peer had
    v.natural("tick_ack", unread, 0, kMaxTick);
  }
  v.real64("time", m.time, -1.0, kMaxTime);
  visit(v, m.pose);
  visit(v, m.twist);
  v.choice("engaged", m.engaged, kHoldsOnNames);
  if (v.agreed(kCouplings)) v.real32("energy", m.energy, -kMaxEnergy, kMaxEnergy);
}

/// Newest samples first, the last few repeated against loss.
struct Poses {
  static constexpr DatagramType kType = DatagramType::kPoses;
  std::vector<PoseSample> samples;
};
template <class V>
void visit(V& v, Poses& m) {
  v.list("samples", m.samples, kMaxPoseRepeats, [](auto& each, PoseSample& sample) { visit(each, sample); });
}

/// Four stamps, as NTP has them: two here, two in the answer.
struct ClockPing {
  static constexpr DatagramType kType = DatagramType::kClockPing;
  std::uint32_t number = 0;
  std::int64_t sent_ns = 0;  ///< the peer's clock
};
template <class V>
void visit(V& v, ClockPing& m) {
  v.natural("number", m.number, 0, 0xffffffff);
  v.stamp("sent_ns", m.sent_ns);
}

struct ClockPong {
  static constexpr DatagramType kType = DatagramType::kClockPong;
  std::uint32_t number = 0;
  std::int64_t ping_sent_ns = 0;  ///< the peer's clock, as it came
  std::int64_t received_ns = 0;   ///< the host's clock
  std::int64_t sent_ns = 0;       ///< the host's clock
};
template <class V>
void visit(V& v, ClockPong& m) {
  v.natural("number", m.number, 0, 0xffffffff);
  v.stamp("ping_sent_ns", m.ping_sent_ns);
  v.stamp("received_ns", m.received_ns);
  v.stamp("sent_ns", m.sent_ns);
}

/// A body as a device loop needs it. A fixed body that nobody measures is never sent.
struct BodyEntry {
  std::uint32_t body = 0;
  Pose pose;    ///< of the mesh frame
  Twist twist;  ///< of the centre of mass
  glm::dvec3 center_of_mass{0.0};
  Wrench fluid;
};
template <class V>
void visit(V& v, BodyEntry& m) {
  v.natural("body", m.body, 0, kMaxBodies - 1);
  visit(v, m.pose);
  visit(v, m.twist);
  v.vec3("center_of_mass", m.center_of_mass, kMaxPosition);
  visit(v, m.fluid);
}

/// A grip's frame follows from its body's pose; what does not is here.
struct GripEntry {
  std::uint32_t grip = 0;
  Pose handle;
  Wrench on_hand;
  // Behind kCouplings, of the sample that the step used:
  std::uint64_t pose_number = 0;  ///< its holder's number of it; 0 = none of the holder's
  bool counted = false;  ///< its holder's site tells it; a hand that the host holds still counts as one
  double energy = 0.0;   ///< J, PoseSample::energy, counted on over all who held the grip
  // Behind kHolds:
  bool stand = false;      ///< the host holds it: nobody's hand
  double stiffness = 0.0;  ///< times the scene's springs, as the next step begins with them; 0 = not told
};
template <class V>
void visit(V& v, GripEntry& m) {
  v.natural("grip", m.grip, 0, kMaxGrips - 1);
  visit(v, m.handle);
  visit(v, m.on_hand);
  if (v.agreed(kCouplings)) {
    v.natural("pose_number", m.pose_number, 0, kMaxTick);
    v.flag("counted", m.counted);
    v.real32("energy", m.energy, -kMaxEnergy, kMaxEnergy);
  }
  if (v.agreed(kHolds)) {
    v.flag("stand", m.stand);
    v.real32("stiffness", m.stiffness, 0.0, kMaxGripStiffness);
  }
}

/// A part (or all) of the bodies at the end of one step. Parts of one tick are joined by the peer; a part
/// that is missing leaves those bodies as they were.
struct Bodies {
  static constexpr DatagramType kType = DatagramType::kBodies;
  std::uint32_t run = 0;  ///< WorldInfo::run
  std::uint64_t tick = 0;
  double time = 0.0;          ///< simulated s
  std::int64_t stamp_ns = 0;  ///< the host's steady clock, as BodyMessage has it
  double rate = 0.0;          ///< simulated s a wall s
  std::uint32_t status = 0;
  std::uint64_t pose_number = 0;   ///< number of the newest of this peer's samples that the step used
  std::int64_t pose_stamp_ns = 0;  ///< its stamp, on the peer's clock; 0 = none yet
  std::uint32_t parts = 1;         ///< datagrams that this tick was cut into
  std::uint32_t part = 0;
  std::vector<BodyEntry> bodies;
  std::vector<GripEntry> grips;
};
template <class V>
void visit(V& v, Bodies& m) {
  v.natural("run", m.run, 0, 0xffffffff);
  v.natural("tick", m.tick, 0, kMaxTick);
  v.real64("time", m.time, -1.0, kMaxTime);
  v.stamp("stamp_ns", m.stamp_ns);
  v.real32("rate", m.rate, 0.0, 100.0);
  v.natural("status", m.status, 0, 0xffffffff);
  v.natural("pose_number", m.pose_number, 0, kMaxTick);
  v.stamp("pose_stamp_ns", m.pose_stamp_ns);
  v.natural("parts", m.parts, 1, 256);
  v.below("part", m.part, 255, "parts", m.parts);
  v.list("bodies", m.bodies, kMaxBodies, [](auto& each, BodyEntry& entry) { visit(each, entry); });
  v.list("grips", m.grips, kMaxGrips, [](auto& each, GripEntry& entry) { visit(each, entry); });
}

/// Other people's hands, passed on as they come: a replica's coupling needs their poses, not their forces.
struct HandEntry {
  std::uint32_t grip = 0;
  std::int64_t received_ns = 0;  ///< the host's clock
  Pose pose;
  Twist twist;
  bool engaged = false;
};
template <class V>
void visit(V& v, HandEntry& m) {
  v.natural("grip", m.grip, 0, kMaxGrips - 1);
  v.stamp("received_ns", m.received_ns);
  visit(v, m.pose);
  visit(v, m.twist);
  v.flag("engaged", m.engaged);
}
struct Hands {
  static constexpr DatagramType kType = DatagramType::kHands;
  std::vector<HandEntry> hands;
};
template <class V>
void visit(V& v, Hands& m) {
  v.list("hands", m.hands, kMaxGrips, [](auto& each, HandEntry& entry) { visit(each, entry); });
}

/// What a peer got of the particles, 5–20 times a second. The host mends what is missing and fits rate and
/// precision to what arrives.
struct BlockRange {
  std::uint32_t first = 0;
  std::uint32_t count = 1;
};
template <class V>
void visit(V& v, BlockRange& m) {
  v.natural("first", m.first, 0, 0xffffff);
  v.natural("count", m.count, 1, 0xffffff);
  v.rule("count", m.first + m.count <= 0x1000000, "reaches past the last block");
}
struct SnapshotFeedback {
  static constexpr DatagramType kType = DatagramType::kSnapshotFeedback;
  std::uint32_t stream = 0;  ///< SnapshotPiece's stream
  std::uint32_t epoch = 0;
  std::uint64_t frame = 0;          ///< the newest of which anything came
  std::uint32_t pieces = 0;         ///< received since the last feedback
  std::uint32_t pieces_sent = 0;    ///< by their numbers, that the host must have sent in that time
  std::vector<BlockRange> missing;  ///< blocks that cannot be decoded without a mending piece
};
template <class V>
void visit(V& v, SnapshotFeedback& m) {
  v.natural("stream", m.stream, 0, 255);
  v.natural("epoch", m.epoch, 0, 0xffffffff);
  v.natural("frame", m.frame, 0, kMaxTick);
  v.natural("pieces", m.pieces, 0, 0xffffffff);
  v.natural("pieces_sent", m.pieces_sent, 0, 0xffffffff);
  v.list("missing", m.missing, kMaxMissingRanges, [](auto& each, BlockRange& range) { visit(each, range); });
}

}  // namespace slosh::wire
