// Recordings: what is on the disk runs again to the bit, or an error says where it does not.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "host/keep/rebuild.h"
#include "host/keep/replay.h"
#include "tests/host/keep_kit.h"

namespace slosh::keep {
namespace {

using Kind = RecordingEvent::Kind;

struct Recorded {
  path file;
  std::uint64_t hash = 0;
  RecordingReport report;
};

RecordingOptions recording_options(const path& file) {
  RecordingOptions options;
  options.file = file;
  options.version = "0.0.test";
  options.backend = "cpu";
  options.hash_ticks = 10;
  options.state_seconds = 0.1;
  return options;
}

Recorded record(const RecordingOptions& options, double seconds, bool eventful) {
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
Played play(RecordingReader& reader, World* world) {
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

TEST(Recording, RunsAgainToTheBitThroughResetsAndChanges) {
  const Recorded recorded = record(recording_options(fresh_folder() / "run"), 0.4, true);
  EXPECT_EQ(recorded.report.problem, "");
  EXPECT_EQ(recorded.report.totals.ended_early, "");
  EXPECT_EQ(recorded.report.totals.changes, 5u);
  EXPECT_EQ(recorded.report.bytes, std::filesystem::file_size(recorded.file));
  auto reader = RecordingReader::open(recorded.file);
  ASSERT_TRUE(reader) << reader.error().text();
  const RecordingHead& head = reader.value()->head();
  EXPECT_EQ(head.version, "0.0.test");
  EXPECT_EQ(head.backend, "cpu");
  Result<RebuiltWorld> rebuilt =
      rebuild_world(head.scene, head.spacing, head.world, WorldOptions{2, Backend::kCpu});
  ASSERT_TRUE(rebuilt) << rebuilt.error().text();
  const Played played = play(*reader.value(), &rebuilt.value().world);
  EXPECT_EQ(played.problem, "");
  EXPECT_TRUE(played.complete);
  EXPECT_EQ(played.differ, 0u);
  EXPECT_EQ(played.agree, recorded.report.totals.hashes);
  EXPECT_GT(played.agree, 5u);
  EXPECT_GT(played.states, 1u);
  EXPECT_GT(played.bodies, 10u);
  EXPECT_EQ(played.steps, recorded.report.totals.steps);
  EXPECT_EQ(played.hash, recorded.hash);
}

TEST(Replay, SaysThatAllHashesAgreeOrWhichDoesNot) {
  const Recorded recorded = record(recording_options(fresh_folder() / "run"), 0.2, true);
  const auto replayed = [](const path& file) {
    auto replayer = Replayer::open(file, {1, Backend::kAuto});
    EXPECT_TRUE(replayer) << replayer.error().text();
    while (true) {
      const Result<bool> stepped = replayer.value()->step();
      EXPECT_TRUE(stepped) << stepped.error().text();
      if (!stepped || !stepped.value()) break;
    }
    return std::move(replayer.value());
  };
  const auto same = replayed(recorded.file);
  const std::string all = std::to_string(recorded.report.totals.hashes);
  EXPECT_TRUE(same->verdict().same(0.01));
  EXPECT_EQ(same->verdict().text(0.01), all + " of " + all + " hashes agree");
  EXPECT_EQ(same->verdict().steps, recorded.report.totals.steps);
  EXPECT_EQ(same->verdict().resets, 1u);
  EXPECT_EQ(same->world().hash(), recorded.hash);
  EXPECT_LT(same->verdict().farthest, 1e-6) << "but for the rounding to float";

  // The last hash, which ends the last events, is made another.
  const Bytes bytes = read_all(recorded.file);
  Bytes other(bytes.begin(), bytes.begin() + 12);
  {
    const MemoryFile file(bytes);
    std::fseek(file.get(), 12, SEEK_SET);
    ChunkReader chunks(file.get());
    std::vector<Chunk> all_chunks;
    Chunk chunk;
    while (chunks.next(chunk) == ChunkOutcome::kChunk) all_chunks.push_back(chunk);
    ASSERT_GT(all_chunks.size(), 5u);
    all_chunks[all_chunks.size() - 2].content.back() ^= 1;
    for (const Chunk& each : all_chunks) append_chunk(each.type, each.content, other);
  }
  const path changed = recorded.file.parent_path() / "changed";
  std::ofstream(changed, std::ios::binary)
      .write(reinterpret_cast<const char*>(other.data()), static_cast<std::streamsize>(other.size()));
  const auto differs = replayed(changed);
  EXPECT_FALSE(differs->verdict().same(0.01));
  EXPECT_EQ(differs->verdict().agree + 1, differs->verdict().hashes);
  EXPECT_NE(differs->verdict().text(0.01).find("first that differs is at tick " +
                                               std::to_string(differs->world().tick())),
            std::string::npos)
      << differs->verdict().text(0.01);

  std::filesystem::resize_file(recorded.file, bytes.size() - 30);
  const auto cut = replayed(recorded.file);
  EXPECT_TRUE(cut->verdict().same(0.01)) << "as far as it goes";
  EXPECT_NE(cut->verdict().text(0.01).find("cut off"), std::string::npos);
}

TEST(Replay, OnAnotherBackendComparesBodies) {
  RecordingOptions options = recording_options(fresh_folder() / "run");
  options.backend = "cuda";  // as it would say
  const Recorded recorded = record(options, 0.1, false);
  auto opened = Replayer::open(recorded.file, {1, Backend::kCpu});
  ASSERT_TRUE(opened);
  Replayer& replayer = *opened.value();
  while (replayer.step().value()) {
  }
  EXPECT_FALSE(replayer.verdict().hashes_comparable);
  EXPECT_EQ(replayer.verdict().hashes, 0u);
  EXPECT_GT(replayer.verdict().bodies, 3u);
  EXPECT_TRUE(replayer.verdict().same(0.01));
  EXPECT_NE(replayer.verdict().text(0.01).find("another backend"), std::string::npos);
}

TEST(Recording, CutOffAnywhereIsReadableUpToThere) {
  RecordingOptions options = recording_options(fresh_folder() / "run");
  options.chunk_seconds = 0.0;  // many small chunks
  const Recorded recorded = record(options, 0.12, true);
  const Bytes bytes = read_all(recorded.file);
  std::uint64_t before = 0;
  std::size_t first_readable = 0;
  const auto at_length = [&](std::size_t length) {
    const MemoryFile file(ByteView(bytes).first(length));
    auto reader = RecordingReader::open(file.get(), "cut");
    if (!reader) {
      EXPECT_EQ(first_readable, 0u) << reader.error().text();
      EXPECT_EQ(reader.error().where, "cut");
      return;
    }
    if (first_readable == 0) first_readable = length;
    const Played played = play(*reader.value(), nullptr);
    EXPECT_EQ(played.problem, "") << "at " << length;
    EXPECT_GE(played.steps, before);
    EXPECT_EQ(played.complete, length == bytes.size());
    before = played.steps;
  };
  // The scene and the first state are long: sampled. Every byte of what follows.
  std::size_t events_from = 0;
  {
    const MemoryFile file(bytes);
    std::fseek(file.get(), 12, SEEK_SET);
    ChunkReader chunks(file.get());
    Chunk chunk;
    for (int i = 0; i < 5; ++i) ASSERT_EQ(chunks.next(chunk), ChunkOutcome::kChunk);
    events_from = chunks.at();
  }
  for (std::size_t length = 0; length < 300; ++length) at_length(length);
  for (std::size_t length = 300; length + 40 < events_from; length += 997) at_length(length);
  // Opening reads the scene, which takes its time.
  const std::size_t stride = std::max<std::size_t>(1, (bytes.size() - events_from) / 600);
  for (std::size_t length = events_from - 40; length < bytes.size(); length += stride) at_length(length);
  at_length(bytes.size());
  EXPECT_EQ(before, recorded.report.totals.steps);
}

TEST(Recording, DamagedSaysWhere) {
  const Recorded recorded = record(recording_options(fresh_folder() / "run"), 0.05, false);
  const Bytes bytes = read_all(recorded.file);
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) {
    Bytes damaged = bytes;
    const std::size_t at = i < 60 ? static_cast<std::size_t>(i) : random() % bytes.size();
    damaged[at] ^= static_cast<std::uint8_t>(1u << random() % 8);
    const MemoryFile file(damaged);
    auto reader = RecordingReader::open(file.get(), "bad");
    std::string problem;
    if (reader) {
      const Played played = play(*reader.value(), nullptr);
      problem = played.problem;
      // A length that points beyond the end looks as if the file were cut off there.
      EXPECT_TRUE(!problem.empty() || !played.complete) << "byte " << at;
    } else {
      problem = reader.error().text();
    }
    EXPECT_TRUE(problem.empty() || problem.rfind("bad: ", 0) == 0) << problem;
  }
}

TEST(Recording, HasTheWorldsParametersWhateverItsCallerKnows) {
  const path file = fresh_folder() / "run";
  Rig rig(until(0.05));
  auto writer =
      RecordingWriter::start(small_world().scene, small_world().sampled.spacing, rig.host.start_state(),
                             rig.host.world(), HostState{}, recording_options(file));
  ASSERT_TRUE(writer) << writer.error().text();
  rig.host.add_tap(*writer.value());
  rig.run();
  writer.value()->finish();
  auto reader = RecordingReader::open(file);
  ASSERT_TRUE(reader) << reader.error().text();
  EXPECT_EQ(reader.value()->head().state.viscosities, rig.host.state().viscosities);
  EXPECT_GT(play(*reader.value(), nullptr).steps, 10u);
}

TEST(Recording, OfAHostThatWroteNoParametersIsReadToo) {
  const Recorded recorded = record(recording_options(fresh_folder() / "run"), 0.05, false);
  const Bytes bytes = read_all(recorded.file);
  Bytes old(bytes.begin(), bytes.begin() + 12);
  {
    const MemoryFile file(bytes);
    std::fseek(file.get(), 12, SEEK_SET);
    ChunkReader chunks(file.get());
    Chunk chunk;
    while (chunks.next(chunk) == ChunkOutcome::kChunk) {
      if (chunk.type == 1) {  // the head ends with how many there are, and them
        ASSERT_EQ(small_world().scene.fluids.size(), 1u);
        chunk.content.resize(chunk.content.size() - 8);
        ASSERT_EQ(chunk.content.back(), 1u);
        chunk.content.back() = 0;
      }
      append_chunk(chunk.type, chunk.content, old);
    }
  }
  const MemoryFile file(old);
  auto reader = RecordingReader::open(file.get(), "old");
  ASSERT_TRUE(reader) << reader.error().text();
  EXPECT_EQ(play(*reader.value(), nullptr).steps, recorded.report.totals.steps);
}

/// The number after --seconds in an error's advice; negative when it gives none.
double advised_seconds(const std::string& error) {
  const std::string word = "--seconds ";
  const std::size_t at = error.find(word);
  return at == std::string::npos ? -1.0 : std::atof(error.c_str() + at + word.size());
}

TEST(Replay, OfADamagedRecordingGoesAsFarAsTheAdviceSays) {
  const Recorded recorded = record(recording_options(fresh_folder() / "run"), 0.4, true);
  const Bytes bytes = read_all(recorded.file);
  int advised = 0, hopeless = 0;
  for (std::size_t at = 700; at < bytes.size(); at += bytes.size() / 14) {
    Bytes damaged = bytes;
    damaged[at] ^= 0x10;
    const path file = recorded.file.parent_path() / "damaged";
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(damaged.data()), static_cast<std::streamsize>(damaged.size()));
    std::string problem;
    {
      auto opened = Replayer::open(file, {1, Backend::kAuto});
      if (!opened) {
        problem = opened.error().text();
        EXPECT_LT(advised_seconds(problem), 0.0) << "byte " << at << ": " << problem;
        hopeless += 1;
        continue;
      }
      while (true) {
        const Result<bool> stepped = opened.value()->step();
        if (!stepped) problem = stepped.error().text();
        if (!stepped || !stepped.value()) break;
      }
    }
    if (problem.empty()) continue;  // it looks cut off
    const double seconds = advised_seconds(problem);
    if (seconds < 0.0) {
      EXPECT_NE(problem.find("Nothing of it can be replayed"), std::string::npos) << problem;
      continue;
    }
    // As `slosh replay --seconds` does it.
    advised += 1;
    auto again = Replayer::open(file, {1, Backend::kAuto});
    ASSERT_TRUE(again);
    const double half_step = 0.5 * again.value()->world().plan().time_step;
    while (again.value()->elapsed() + half_step < seconds) {
      const Result<bool> stepped = again.value()->step();
      ASSERT_TRUE(stepped && stepped.value()) << "byte " << at << ": --seconds " << seconds;
    }
    EXPECT_GT(again.value()->verdict().steps, 0u);
    EXPECT_TRUE(again.value()->verdict().same(0.01)) << again.value()->verdict().text(0.01);
  }
  EXPECT_GT(advised, 1);
  EXPECT_GT(hopeless, 0);
}

TEST(Recording, OfALargeStateNeedsNoLargerQueue) {
  RecordingOptions options = recording_options(fresh_folder() / "run");
  Rig rig(until(0.0));
  Bytes state;
  ASSERT_TRUE(rig.host.world().save(state));
  options.queue_bytes = state.size() - 1;
  const Recorded recorded = record(options, 0.3, false);
  EXPECT_EQ(recorded.report.totals.ended_early, "");
  EXPECT_GT(recorded.report.totals.states, 0u);
  auto reader = RecordingReader::open(recorded.file);
  ASSERT_TRUE(reader);
  World world = small_world().world();
  const Played played = play(*reader.value(), &world);
  EXPECT_TRUE(played.complete);
  EXPECT_EQ(played.differ, 0u);
  EXPECT_EQ(played.steps, recorded.report.totals.steps);
}

TEST(Recording, OverwritesNothing) {
  const path file = fresh_folder() / "run";
  std::ofstream(file) << "an afternoon's work";
  Rig rig(until(0.01));
  const auto start = [&] {
    return RecordingWriter::start(small_world().scene, small_world().sampled.spacing, rig.host.start_state(),
                                  rig.host.world(), rig.host.state(), recording_options(file));
  };
  const auto refused = start();
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("is there already"), std::string::npos) << refused.error().text();
  std::string kept;
  std::getline(std::ifstream(file) >> std::ws, kept);
  EXPECT_EQ(kept, "an afternoon's work");
  std::ofstream(file, std::ios::trunc).flush();
  EXPECT_TRUE(start()) << "an empty file holds nothing";
}

TEST(Recording, ThatTheDiskCannotFollowEndsCleanly) {
  RecordingOptions options = recording_options(fresh_folder() / "run");
  options.queue_bytes = 100;  // less than a chunk of events
  const Recorded recorded = record(options, 0.3, false);
  EXPECT_NE(recorded.report.totals.ended_early.find("did not keep up"), std::string::npos)
      << recorded.report.totals.ended_early;
  auto reader = RecordingReader::open(recorded.file);
  ASSERT_TRUE(reader);
  const Played played = play(*reader.value(), nullptr);
  EXPECT_EQ(played.problem, "");
  EXPECT_TRUE(played.complete) << "its end mark says why";
}

}  // namespace
}  // namespace slosh::keep
