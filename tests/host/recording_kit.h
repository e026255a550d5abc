// What the tests of recordings share: a run that is recorded, and a recording that is played.
#pragma once

#include <cstring>
#include <random>

#include "host/keep/rebuild.h"
#include "host/keep/replay.h"
#include "tests/host/keep_kit.h"

namespace slosh::keep {

using Kind = RecordingEvent::Kind;

struct Recorded {
  path file;
  std::uint64_t hash = 0;
  RecordingReport report;
};

inline RecordingOptions recording_options(const path& file) {
  RecordingOptions options;
  options.file = file;
  options.version = "0.0.test";
  options.backend = "cpu";
  options.hash_ticks = 10;
  options.state_seconds = 0.1;
  return options;
}

inline Recorded record(const RecordingOptions& options, double seconds, bool eventful) {
  Rig rig(until(seconds));
  auto writer = RecordingWriter::start(small_world().scene, small_world().sampled.spacing,
                                       rig.host.start_state(), rig.host.world(), rig.host.state(), options);
  EXPECT_TRUE(writer) << writer.error().text();
  rig.host.add_tap(*writer.value());
  AtTick lighter(12, [&] { rig.host.post({HostAction::kGravityScale, 0, 0.5}); });
  AtTick reset(33, [&] { rig.host.post({HostAction::kReset}); });
  AtTick pause(45, [&] {
    rig.host.post({HostAction::kPause});
    rig.host.post({HostAction::kViscosity, 0, 0.002});
    rig.host.post({HostAction::kGripStiffness, 0, 0.3});
    rig.host.post({HostAction::kContinue});
  });
  if (eventful) {
    for (AtTick* tap : {&lighter, &reset, &pause}) rig.host.add_tap(*tap);
  }
  rig.run();
  Recorded recorded{options.file, rig.host.world().hash(), writer.value()->finish()};
  return recorded;
}

struct Played {
  std::uint64_t steps = 0, agree = 0, differ = 0, states = 0, bodies = 0;
  bool complete = false;
  std::string problem;
  std::uint64_t hash = 0;
};

/// Runs a recording again; with a world, or only through the reader.
inline Played play(RecordingReader& reader, World* world) {
  Played played;
  while (true) {
    const Result<const RecordingEvent*> event = reader.next();
    if (!event) {
      played.problem = event.error().text();
      break;
    }
    if (event.value() == nullptr) break;
    const RecordingEvent& e = *event.value();
    played.steps += e.kind == Kind::kStep;
    if (world == nullptr) continue;
    switch (e.kind) {
      case Kind::kStep:
        world->step(e.hands);
        break;
      case Kind::kBodies:
        played.bodies += 1;
        break;
      case Kind::kHash:
        (e.hash == world->hash() ? played.agree : played.differ) += 1;
        break;
      case Kind::kChange:
        if (e.change.action == HostAction::kReset) {
          EXPECT_TRUE(reset_world(*world, reader.head().scene.fluids.size(), reader.head().start));
        } else if (e.change.action == HostAction::kGravityScale) {
          EXPECT_TRUE(world->set_gravity_scale(e.change.value));
        } else if (e.change.action == HostAction::kViscosity) {
          EXPECT_TRUE(world->set_viscosity(e.change.index, e.change.value));
        } else if (e.change.action == HostAction::kGripStiffness) {
          EXPECT_TRUE(world->set_grip_stiffness(e.change.index, e.change.value));
        }
        break;
      case Kind::kState: {
        World other = small_world().world();
        EXPECT_TRUE(other.restore(e.state));
        EXPECT_EQ(other.hash(), world->hash());
        played.states += 1;
        break;
      }
      case Kind::kEnd:
        break;
    }
    EXPECT_TRUE(e.kind == Kind::kEnd || e.tick == world->tick());
  }
  played.complete = reader.complete();
  if (world) played.hash = world->hash();
  return played;
}

}  // namespace slosh::keep
