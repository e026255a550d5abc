// The bytes of a recording that its writer and its reader share.
#pragma once

#include "host/keep/recording.h"
#include "net/wire/fields.h"
#include "net/wire/messages.h"

namespace slosh::keep {

inline constexpr char kRecordingMagic[8] = {'S', 'L', 'O', 'S', 'H', 'R', 'E', 'C'};
inline constexpr std::uint32_t kRecordingVersion = 1;

enum RecordingChunk : std::uint8_t {
  kHeadChunk = 1,
  kSceneChunk,
  kStartChunk,   ///< what a reset goes back to; empty = the first state
  kStateChunk,   ///< StateHead, then World::save
  kEventsChunk,  ///< EventsHead, then events: one byte that says which, and its content
  kEndChunk,
};

enum RecordingTag : std::uint8_t {
  kStepExpected = 1,  ///< all hands as HandCoder expects them
  kStepHands,         ///< HandCoder
  kBodiesTag,         ///< a BodyRecord a free body of the scene
  kHashTag,           ///< 64 bits
  kChangeTag,         ///< ChangeRecord
};

struct HeadRecord {
  double time_step = 0.0;
  std::string version;
  std::string backend;
  HostState state;
};
template <class V>
void visit(V& v, HeadRecord& m) {
  v.real64("time_step", m.time_step, 1e-7, 1.0);
  v.text("version", m.version, 64);
  v.text("backend", m.backend, 64);
  v.flag("paused", m.state.paused);
  v.natural("run", m.state.run, 0, 0xffffffff);
  v.real64("gravity_scale", m.state.gravity_scale, 0.0, kMaxGravityScale);
  v.list("viscosities", m.state.viscosities, 255,
         [](auto& each, double& value) { each.real64("viscosity", value, 0.0, 1e9); });
}

/// Where the world is at the first event of a chunk, or in a state.
struct PlaceRecord {
  std::uint64_t tick = 0;
  std::uint32_t run = 0;
};
template <class V>
void visit(V& v, PlaceRecord& m) {
  v.natural("tick", m.tick, 0, wire::kMaxTick);
  v.natural("run", m.run, 0, 0xffffffff);
}

struct ChangeRecord {
  HostCommand command;
};
template <class V>
void visit(V& v, ChangeRecord& m) {
  v.choice("action", m.command.action, 8);
  v.natural("index", m.command.index, 0, wire::kMaxBodies + wire::kMaxFluidVolumes);
  v.real64("value", m.command.value, -1e9, 1e9);
}

template <class V>
void visit(V& v, RecordingTotals& m) {
  v.natural("steps", m.steps, 0, wire::kMaxTick);
  v.natural("hashes", m.hashes, 0, wire::kMaxTick);
  v.natural("changes", m.changes, 0, wire::kMaxTick);
  v.natural("states", m.states, 0, wire::kMaxTick);
  v.text("ended_early", m.ended_early, 200);
}

template <class V>
void visit(V& v, BodyRecord& m) {
  for (int i = 0; i < 3; ++i) v.real32("position", m.pose.position[i], -1e9, 1e9);
  for (double* part :
       {&m.pose.orientation.w, &m.pose.orientation.x, &m.pose.orientation.y, &m.pose.orientation.z})
    v.real32("orientation", *part, -1.01, 1.01);
  for (int i = 0; i < 3; ++i) v.real32("linear", m.twist.linear[i], -1e9, 1e9);
  for (int i = 0; i < 3; ++i) v.real32("angular", m.twist.angular[i], -1e9, 1e9);
}

}  // namespace slosh::keep
