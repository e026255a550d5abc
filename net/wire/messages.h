// Every message between a host and its peers, field by field. WIRE_FORMAT.md is made from these lists.
//
// Control messages travel on one bidirectional stream that the peer opens first: varint type, varint length,
// payload. The scene and nothing else travels on a unidirectional stream of the host's. Datagrams start with
// their type in one byte. A message that does not decode is answered as WIRE_FORMAT.md says and never acted
// on in part.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/channel.h"
#include "net/wire/capabilities.h"
#include "net/wire/fields.h"

namespace slosh::wire {

// ---------------------------------------------------------------- limits

constexpr std::uint32_t kProtocolVersion = 2;
inline constexpr char kAlpn[] =
    "slosh/2";  ///< the TLS application protocol; a peer of another version fails here

constexpr std::size_t kMaxDatagram = 1150;           ///< bytes of payload, before path MTU discovery
constexpr std::size_t kMaxControlMessage = 1 << 17;  ///< bytes of payload; a full RosterChange is the largest
constexpr std::size_t kMaxSceneBytes = 64u << 20;    ///< compressed and decompressed alike
constexpr std::size_t kMaxName = 32;                 ///< bytes of a person's name
constexpr std::size_t kMaxText = 400;                ///< bytes of a sentence
constexpr std::uint32_t kMaxGrips = 64;
constexpr std::uint32_t kMaxBodies = 256;
constexpr std::uint32_t kMaxPeers = 1024;
constexpr std::uint32_t kMaxFluids = 32;
constexpr std::uint64_t kMaxTick = std::uint64_t{1} << 48;
constexpr double kMaxTime = 1e7;                ///< s
constexpr double kMaxPosition = 1e4;            ///< m
constexpr double kMaxSpeed = 1e4;               ///< m/s, rad/s
constexpr double kMaxForce = 1e7;               ///< N, N·m
constexpr std::size_t kMaxPoseRepeats = 13;     ///< as many as fit into a datagram
constexpr std::size_t kMaxMissingRanges = 128;  ///< likewise
constexpr double kMaxViscosity = 1e7;           ///< Pa·s, as scenes have it
constexpr double kMaxGravityScale = 2.0;        ///< times the scene's
constexpr std::size_t kTokenBytes = 16;

using Token = std::array<std::uint8_t, kTokenBytes>;

// ---------------------------------------------------------------- shared parts

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

// ---------------------------------------------------------------- control: both ways

enum class ControlType : std::uint8_t {
  // peer → host
  kHello = 1,
  kGripRequest = 2,
  kWorldRequest = 3,
  kParameterRequest = 4,
  kBye = 5,
  // host → peer
  kWelcome = 16,
  kRefused = 17,
  kRoster = 18,
  kAnswer = 19,
  kWorldInfo = 20,
  kNotice = 21,
  kRosterChange = 22,
};

enum class Role : std::uint8_t { kParticipant, kSpectator };
constexpr std::array kRoleNames{"participant", "spectator"};
constexpr std::uint64_t kRoles = kRoleNames.size();

/// What a peer wants of the particles.
enum class SnapshotWish : std::uint8_t {
  kNewest,  ///< for a window
  kFilm,    ///< every snapshot
  kNone,    ///< it draws nothing: bodies alone
};
constexpr std::array kSnapshotWishNames{"the newest", "all, for a film", "none"};
constexpr std::uint64_t kSnapshotWishes = kSnapshotWishNames.size();

constexpr std::size_t kMaxLater = 1024;  ///< bytes of what a newer peer adds to its Hello

/// The peer's first message. Its key is the one of its TLS certificate.
struct Hello {
  static constexpr ControlType kType = ControlType::kHello;
  std::uint32_t version = kProtocolVersion;
  Token token{};
  std::string name;  ///< how others see this person; empty = the host chooses
  SnapshotWish snapshots = SnapshotWish::kNewest;
  Capabilities capabilities = kOurCapabilities;  ///< bits that are not known are left out of account
  Bytes later;  ///< fields of capabilities that this version does not know; skipped
};
template <class V>
void visit(V& v, Hello& m) {
  v.natural("version", m.version, 0, 0xffff);
  v.array("token", m.token);
  v.text("name", m.name, kMaxName);
  v.choice("snapshots", m.snapshots, kSnapshotWishNames);
  v.bits64("capabilities", m.capabilities);
  v.bytes("later", m.later, 0, kMaxLater);
}

/// Take or release one grip. Answered by Answer with the same `request`.
struct GripRequest {
  static constexpr ControlType kType = ControlType::kGripRequest;
  std::uint32_t request = 0;  ///< the peer's number for the answer
  std::uint32_t grip = 0;
  bool take = true;
};
template <class V>
void visit(V& v, GripRequest& m) {
  v.natural("request", m.request, 0, 0xffffffff);
  v.natural("grip", m.grip, 0, kMaxGrips - 1);
  v.flag("take", m.take);
}

enum class WorldAction : std::uint8_t { kPause, kContinue, kReset };
constexpr std::array kWorldActionNames{"pause", "continue", "reset"};
constexpr std::uint64_t kWorldActions = kWorldActionNames.size();

struct WorldRequest {
  static constexpr ControlType kType = ControlType::kWorldRequest;
  std::uint32_t request = 0;
  WorldAction action = WorldAction::kPause;
};
template <class V>
void visit(V& v, WorldRequest& m) {
  v.natural("request", m.request, 0, 0xffffffff);
  v.choice("action", m.action, kWorldActionNames);
}

/// What may change while the world runs.
enum class Parameter : std::uint8_t {
  kFluidViscosity,  ///< Pa·s; index = fluid
  kGravityScale,    ///< times the scene's, 0–2; index unused
};
constexpr std::array kParameterNames{"fluid viscosity", "gravity scale"};
constexpr std::uint64_t kParameters = kParameterNames.size();

struct ParameterRequest {
  static constexpr ControlType kType = ControlType::kParameterRequest;
  std::uint32_t request = 0;
  Parameter parameter = Parameter::kFluidViscosity;
  std::uint32_t index = 0;
  double value = 0.0;
};
template <class V>
void visit(V& v, ParameterRequest& m) {
  v.natural("request", m.request, 0, 0xffffffff);
  v.choice("parameter", m.parameter, kParameterNames);
  v.natural("index", m.index, 0, kMaxFluids - 1);
  v.real64("value", m.value, 0.0, kMaxViscosity);
}

/// Either side is about to close, and says why.
struct Bye {
  static constexpr ControlType kType = ControlType::kBye;
  std::string reason;
};
template <class V>
void visit(V& v, Bye& m) {
  v.text("reason", m.reason, kMaxText);
}

/// The peer is in. The scene follows on its own stream.
struct Welcome {
  static constexpr ControlType kType = ControlType::kWelcome;
  std::uint32_t peer = 0;  ///< this peer's number in Roster
  Role role = Role::kSpectator;
  std::string name;                              ///< as the others see it
  std::uint64_t world = 0;                       ///< names the host's world; the same after a resume
  std::uint64_t scene_bytes = 0;                 ///< compressed, on the scene's stream
  std::uint64_t particles = 0;                   ///< fluid particles at the start
  double spacing = 0.01;                         ///< m between particles
  double time_step = 0.001;                      ///< s, a tick's length
  double snapshot_rate = 0.0;                     ///< snapshots a second that the host can send at most
  bool restored = false;                         ///< a seat of the last minute was given back with its grips
  Capabilities capabilities = kOurCapabilities;  ///< agreed: the host's, of those that Hello named
};
template <class V>
void visit(V& v, Welcome& m) {
  v.natural("peer", m.peer, 0, kMaxPeers - 1);
  v.choice("role", m.role, kRoleNames);
  v.text("name", m.name, kMaxName);
  v.bits64("world", m.world);
  v.natural("scene_bytes", m.scene_bytes, 0, kMaxSceneBytes);
  v.natural("particles", m.particles, 0, 100'000'000);
  v.real64("spacing", m.spacing, 1e-5, 10.0);
  v.real64("time_step", m.time_step, 1e-7, 1.0);
  v.real64("snapshot_rate", m.snapshot_rate, 0.0, 1000.0);
  v.flag("restored", m.restored);
  v.bits64("capabilities", m.capabilities);
}

enum class RefusalCode : std::uint8_t {
  kBadToken,  ///< unknown; a revoked or expired one is told apart only in words, to who once held it
  kRevoked,
  kExpired,
  kFull,
  kVersion,
  kBadMessage,  ///< something did not decode, or came out of turn
  kTooMuch,     ///< flooded
  kReplaced,    ///< the same person came again from elsewhere
  kEnding,      ///< the host ends
  kTimedOut,
  kBanned,  ///< the host keeps this key out for a time
  kBusy,    ///< too many at the door now: trying again soon helps
};
constexpr std::array kRefusalNames{"bad token", "revoked",  "expired", "full",      "version", "bad message",
                                   "too much",  "replaced", "ending",  "timed out", "banned",  "busy"};
constexpr std::uint64_t kRefusalCodes = kRefusalNames.size();

/// The host's last message before it closes.
struct Refused {
  static constexpr ControlType kType = ControlType::kRefused;
  RefusalCode code = RefusalCode::kBadToken;
  std::string text;  ///< for people
};
template <class V>
void visit(V& v, Refused& m) {
  v.choice("code", m.code, kRefusalNames);
  v.text("text", m.text, kMaxText);
}

struct RosterEntry {
  std::uint32_t peer = 0;
  std::string name;
  Role role = Role::kSpectator;
  bool connected = true;  ///< false: away, its seat is kept for a while
  std::vector<std::uint32_t> grips;

  bool operator==(const RosterEntry&) const = default;
};
template <class V>
void visit(V& v, RosterEntry& m) {
  v.natural("peer", m.peer, 0, kMaxPeers - 1);
  v.text("name", m.name, kMaxName);
  v.choice("role", m.role, kRoleNames);
  v.flag("connected", m.connected);
  v.list("grips", m.grips, kMaxGrips,
         [](auto& each, std::uint32_t& grip) { each.natural("grip", grip, 0, kMaxGrips - 1); });
}

/// Who is here and who holds what, whole: once after Welcome, and where kRosterChanges is not agreed after
/// every change.
struct Roster {
  static constexpr ControlType kType = ControlType::kRoster;
  std::vector<RosterEntry> peers;
};
template <class V>
void visit(V& v, Roster& m) {
  v.list("peers", m.peers, kMaxPeers, [](auto& each, RosterEntry& entry) { visit(each, entry); });
}

/// What is new since the last Roster or RosterChange. Behind kRosterChanges.
struct RosterChange {
  static constexpr ControlType kType = ControlType::kRosterChange;
  std::vector<RosterEntry> changed;  ///< as they are now
  std::vector<std::uint32_t> gone;   ///< numbers; one may be given to somebody else, who is in `changed` then
};
template <class V>
void visit(V& v, RosterChange& m) {
  v.list("changed", m.changed, kMaxPeers, [](auto& each, RosterEntry& entry) { visit(each, entry); });
  v.list("gone", m.gone, kMaxPeers,
         [](auto& each, std::uint32_t& peer) { each.natural("peer", peer, 0, kMaxPeers - 1); });
}

/// To one request.
struct Answer {
  static constexpr ControlType kType = ControlType::kAnswer;
  std::uint32_t request = 0;
  bool granted = false;
  std::string text;  ///< the reason, for people; may be empty when granted
};
template <class V>
void visit(V& v, Answer& m) {
  v.natural("request", m.request, 0, 0xffffffff);
  v.flag("granted", m.granted);
  v.text("text", m.text, kMaxText);
}

/// The world's switches, whole, after every change.
struct WorldInfo {
  static constexpr ControlType kType = ControlType::kWorldInfo;
  bool paused = false;
  std::uint32_t run = 0;  ///< rises by one with every reset
  double gravity_scale = 1.0;
  std::vector<double> viscosities;  ///< Pa·s, one a fluid
};
template <class V>
void visit(V& v, WorldInfo& m) {
  v.flag("paused", m.paused);
  v.natural("run", m.run, 0, 0xffffffff);
  v.real64("gravity_scale", m.gravity_scale, 0.0, kMaxGravityScale);
  v.list("viscosities", m.viscosities, kMaxFluids,
         [](auto& each, double& value) { each.real64("viscosity", value, 0.0, kMaxViscosity); });
}

/// Something to tell a person: who came, who went, what was refused.
struct Notice {
  static constexpr ControlType kType = ControlType::kNotice;
  std::string text;
};
template <class V>
void visit(V& v, Notice& m) {
  v.text("text", m.text, kMaxText);
}

// ---------------------------------------------------------------- datagrams

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
};

/// One reading of one device.
struct PoseSample {
  std::uint32_t grip = 0;
  std::uint64_t number = 0;    ///< of this grip's samples, rising by one; repeats have the same number
  std::int64_t stamp_ns = 0;   ///< the peer's steady clock when the device was read
  std::uint64_t tick_ack = 0;  ///< newest body state that the peer had
  double time = 0.0;           ///< simulated s that it belongs to
  Pose pose;
  Twist twist;
  bool engaged = false;
};
template <class V>
void visit(V& v, PoseSample& m) {
  v.natural("grip", m.grip, 0, kMaxGrips - 1);
  v.natural("number", m.number, 0, kMaxTick);
  v.stamp("stamp_ns", m.stamp_ns);
  v.natural("tick_ack", m.tick_ack, 0, kMaxTick);
  v.real64("time", m.time, -1.0, kMaxTime);
  visit(v, m.pose);
  visit(v, m.twist);
  v.flag("engaged", m.engaged);
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
};
template <class V>
void visit(V& v, GripEntry& m) {
  v.natural("grip", m.grip, 0, kMaxGrips - 1);
  visit(v, m.handle);
  visit(v, m.on_hand);
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

// ---------------------------------------------------------------- envelopes

/// Type and payload of a datagram in one array. Tells through `fault` what a Writer had to bring into range.
template <class M>
Bytes datagram(const M& message, Fault* fault = nullptr, Capabilities agreed = kAllCapabilities) {
  Bytes out{static_cast<std::uint8_t>(M::kType)};
  const Fault found = encode(message, out, agreed);
  if (fault) *fault = found;
  return out;
}

/// Type, length and payload of a control message; likewise.
template <class M>
Bytes control(const M& message, Fault* fault = nullptr, Capabilities agreed = kAllCapabilities) {
  Bytes payload;
  const Fault found = encode(message, payload, agreed);
  if (fault) *fault = found;
  Bytes out;
  Writer writer(out);
  std::uint64_t type = static_cast<std::uint64_t>(M::kType);
  std::uint64_t length = payload.size();
  writer.natural("type", type, 0, 255);
  writer.natural("length", length, 0, kMaxControlMessage);
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

}  // namespace slosh::wire
