// Messages of the control stream, field by field: who comes and goes, who holds what, the world's switches.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "net/wire/capabilities.h"
#include "net/wire/fields.h"
#include "net/wire/limits.h"
#include "scenes/scene.h"

namespace slosh::wire {

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
  kRights = 23,
  kTask = 24,
  kCuts = 25,
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
  kGripStiffness,   ///< times the scene's; index = grip; where kGripStiffnesses is agreed
};
constexpr std::array kParameterNames{"fluid viscosity", "gravity scale", "grip stiffness"};
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
  v.natural("index", m.index, 0, std::max(kMaxFluids, kMaxGrips) - 1);
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
  double snapshot_rate = 0.0;                    ///< snapshots a second that the host can send at most
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
  std::vector<double>
      grip_stiffness;  ///< times the scene's, one a grip; none where kGripStiffnesses is not agreed
};
template <class V>
void visit(V& v, WorldInfo& m) {
  v.flag("paused", m.paused);
  v.natural("run", m.run, 0, 0xffffffff);
  v.real64("gravity_scale", m.gravity_scale, 0.0, kMaxGravityScale);
  v.list("viscosities", m.viscosities, kMaxFluids,
         [](auto& each, double& value) { each.real64("viscosity", value, 0.0, kMaxViscosity); });
  if (v.agreed(kGripStiffnesses)) {
    v.list("grip_stiffnesses", m.grip_stiffness, kMaxGrips, [](auto& each, double& value) {
      each.real64("grip_stiffness", value, kMinGripStiffness, kMaxGripStiffness);
    });
  }
}

/// What this peer may ask of the world: after the first WorldInfo, and whenever it is another. Behind
/// kLinkRights.
struct Rights {
  static constexpr ControlType kType = ControlType::kRights;
  bool run = false;         ///< to pause it, let it go on and set it back
  bool parameters = false;  ///< to set gravity and viscosities
  bool stiffness = false;   ///< to set the stiffness of the grips that it holds

  bool operator==(const Rights&) const = default;
};
template <class V>
void visit(V& v, Rights& m) {
  v.flag("run", m.run);
  v.flag("parameters", m.parameters);
  v.flag("stiffness", m.stiffness);
}

/// Where the scene's guided task is, in words: after the first WorldInfo, and when it is another, a few times
/// a second. Behind kTasks.
struct Task {
  static constexpr ControlType kType = ControlType::kTask;
  std::string title;
  std::string say;
  std::string now;
  std::string hint;
  std::vector<HandMove> hands;  ///< behind kTaskHands: who holds `from` lets go and takes `to`, in order
  std::uint32_t done = 0;       ///< behind kTaskSteps: steps that are
};
template <class V>
void visit(V& v, Task& m) {
  v.text("title", m.title, kMaxText);
  v.text("say", m.say, kMaxText);
  v.text("now", m.now, kMaxText);
  v.text("hint", m.hint, kMaxText);
  if (v.agreed(kTaskHands))
    v.list("hands", m.hands, kMaxHandMoves, [](auto& each, HandMove& move) {
      each.natural("from", move.from, 0, kMaxGrips - 1);
      each.natural("to", move.to, 0, kMaxGrips - 1);
    });
  if (v.agreed(kTaskSteps)) v.natural("done", m.done, 0, kMaxTaskSteps);
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

}  // namespace slosh::wire
