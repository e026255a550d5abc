// Checkpoints and recordings: what is on the disk is the world, to the bit, or an error in words.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <fstream>
#include <random>

#include "host/keep/checkpoint.h"
#include "host/keep/rebuild.h"
#include "host/keep/recording.h"
#include "host/keep/replay.h"
#include "tests/host/world_kit.h"

namespace slosh::keep {
namespace {

using std::filesystem::path;
using testing::AtTick;
using testing::fresh_folder;
using testing::Rig;
using testing::small_world;
using Kind = RecordingEvent::Kind;

HostOptions until(double time) {
  HostOptions options;
  options.until = time;
  return options;
}

Bytes read_all(const path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes as a file that was never on a disk.
class MemoryFile {
 public:
  explicit MemoryFile(ByteView bytes) : bytes_(bytes.begin(), bytes.end()) {
    // fmemopen takes no file without bytes.
    file_ = bytes_.empty() ? std::tmpfile() : fmemopen(bytes_.data(), bytes_.size(), "rb");
  }
  ~MemoryFile() { std::fclose(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::FILE* get() const { return file_; }

 private:
  Bytes bytes_;
  std::FILE* file_;
};

// ---------------------------------------------------------------- chunks and hands

TEST(Crc, IsThatOfZip) {
  const char text[] = "123456789";
  EXPECT_EQ(crc32({reinterpret_cast<const std::uint8_t*>(text), 9}), 0xcbf43926u);
  EXPECT_EQ(crc32({reinterpret_cast<const std::uint8_t*>(text) + 4, 5},
                  crc32({reinterpret_cast<const std::uint8_t*>(text), 4})),
            0xcbf43926u);
}

TEST(Chunks, ComeBackAndSayWhenTheyAreDamaged) {
  Bytes noise(1000);
  std::mt19937 random(1);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
  Bytes file;
  append_chunk(1, noise, file);
  append_chunk(2, {}, file);
  append_chunk(3, Bytes(500, 7), file);
  EXPECT_LT(file.size(), 1100u) << "packed where it helps";
  const auto read = [](ByteView bytes, std::vector<Chunk>& chunks) {
    const MemoryFile memory(bytes);
    ChunkReader reader(memory.get());
    Chunk chunk;
    ChunkOutcome outcome;
    while ((outcome = reader.next(chunk)) == ChunkOutcome::kChunk) chunks.push_back(chunk);
    return outcome;
  };
  std::vector<Chunk> chunks;
  EXPECT_EQ(read(file, chunks), ChunkOutcome::kEnd);
  ASSERT_EQ(chunks.size(), 3u);
  EXPECT_EQ(chunks[0].content, noise);
  EXPECT_EQ(chunks[2].content, Bytes(500, 7));
  for (std::size_t length = 1; length < file.size(); ++length) {
    chunks.clear();
    const ChunkOutcome outcome = read(ByteView(file).first(length), chunks);
    EXPECT_TRUE(outcome == ChunkOutcome::kCutOff || outcome == ChunkOutcome::kEnd) << length;
    EXPECT_LT(chunks.size(), 3u);
  }
  for (std::size_t at = 0; at < file.size(); ++at) {
    Bytes damaged = file;
    damaged[at] ^= 0x10;
    chunks.clear();
    const ChunkOutcome outcome = read(damaged, chunks);
    EXPECT_NE(outcome, ChunkOutcome::kEnd) << "byte " << at;
    EXPECT_LT(chunks.size(), 3u);
  }
}

TEST(HandCoder, GivesEveryTickBackToTheBit) {
  std::mt19937_64 random(2);
  HandCoder writer(3), reader(3);
  std::vector<HandleInput> hands(3), got;
  const HandleInput nothing;
  std::size_t bytes_at_rest = 0;
  for (int tick = 0; tick < 400; ++tick) {
    const double t = 0.002 * tick;
    const bool rest = tick > 200 && tick < 300;
    if (!rest) {
      hands[0].engaged = tick % 50 < 40;
      hands[0].pose.position = {std::sin(t), -t, 1e-9 * t};
      hands[0].twist.linear = {std::cos(t), -1.0, std::numeric_limits<double>::quiet_NaN()};
      hands[1].engaged = true;
      hands[1].scale = std::min(1.0, t);
      const auto bits = random();
      std::memcpy(&hands[1].pose.position.x, &bits, 8);
    }
    Bytes bytes;
    if (writer.encode(hands, bytes)) {
      ByteView in(bytes);
      ASSERT_TRUE(reader.decode(in, got));
      EXPECT_TRUE(in.empty());
      for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
        HandCoder another(3);
        std::vector<HandleInput> some;
        ByteView part = ByteView(bytes).first(cut);
        EXPECT_FALSE(another.decode(part, some));
      }
    } else {
      EXPECT_TRUE(bytes.empty());
      reader.expected(got);
    }
    if (rest && tick > 202) bytes_at_rest += bytes.size();
    for (std::size_t h = 0; h < 3; ++h) {
      const HandleInput& wanted = hands[h].engaged ? hands[h] : nothing;
      ASSERT_EQ(got[h].engaged, hands[h].engaged);
      ASSERT_EQ(std::memcmp(&got[h].pose, &wanted.pose, sizeof(Pose)), 0) << tick;
      ASSERT_EQ(std::memcmp(&got[h].twist, &wanted.twist, sizeof(Twist)), 0) << tick;
      ASSERT_EQ(got[h].scale, wanted.scale);
    }
  }
  EXPECT_EQ(bytes_at_rest, 0u);
}

// ---------------------------------------------------------------- checkpoints

CheckpointOptions checkpoint_options(const path& folder, double interval = 0.0) {
  CheckpointOptions options;
  options.file = folder / "world.checkpoint";
  options.interval = interval;
  options.version = "0.0.test";
  return options;
}

std::unique_ptr<CheckpointWriter> checkpoint(Rig& rig, const CheckpointOptions& options) {
  auto writer = CheckpointWriter::start(small_world().scene, small_world().sampled.spacing,
                                        rig.host.start_state(), rig.host.world(), rig.host.state(), options);
  EXPECT_TRUE(writer) << writer.error().text();
  rig.host.add_tap(*writer.value());
  return std::move(writer.value());
}

TEST(Checkpoint, ResumedIsTheRunThatWasNeverStopped) {
  const CheckpointOptions options = checkpoint_options(fresh_folder());
  Rig rig(until(0.3));
  std::vector<std::vector<HandleInput>> inputs;
  struct Inputs : HostTap {
    explicit Inputs(std::vector<std::vector<HandleInput>>& to) : all(to) {}
    void before_step(const World&, const StepInput& in) override {
      all.emplace_back(in.hands.begin(), in.hands.end());
    }
    std::vector<std::vector<HandleInput>>& all;
  } tap(inputs);
  rig.host.add_tap(tap);
  auto writer = checkpoint(rig, options);
  writer->set_session({1, 2, 3});
  // The copy in mid-run is kept aside, as a crash at that moment would leave it.
  const path kept = options.file.parent_path() / "kept";
  AtTick crash(25, [&] {
    writer->flush();
    std::filesystem::copy_file(options.file, kept);
  });
  rig.host.add_tap(crash);
  rig.run();
  writer->flush();
  EXPECT_GT(writer->report().written, 2u);
  EXPECT_EQ(writer->report().problem, "");
  writer.reset();

  Result<Checkpoint> read = read_checkpoint(kept);
  ASSERT_TRUE(read) << read.error().text();
  const Checkpoint& c = read.value();
  EXPECT_EQ(c.note, "");
  EXPECT_EQ(c.version, "0.0.test");
  EXPECT_EQ(c.session, (Bytes{1, 2, 3}));
  EXPECT_EQ(c.start, rig.host.start_state());
  EXPECT_GE(c.tick, 20u);
  Result<RebuiltWorld> rebuilt = rebuild_world(c.scene, c.spacing, c.world, WorldOptions{1, Backend::kCpu});
  ASSERT_TRUE(rebuilt) << rebuilt.error().text();
  World& world = rebuilt.value().world;
  EXPECT_EQ(world.tick(), c.tick);
  while (world.tick() < inputs.size()) world.step(inputs[world.tick()]);
  EXPECT_EQ(world.hash(), rig.host.world().hash());

  const Result<Checkpoint> last = read_checkpoint(options.file);
  ASSERT_TRUE(last);
  EXPECT_EQ(last.value().tick, inputs.size()) << "the end is written too";
  struct stat facts{};
  ASSERT_EQ(::stat(options.file.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0600u);
}

TEST(Checkpoint, OfAStandingWorldFollowsTheSessionAndTheSwitches) {
  const CheckpointOptions options = checkpoint_options(fresh_folder(), 1e9);
  HostOptions host = until(1e9);
  host.paused = true;
  Rig rig(host);
  auto writer = checkpoint(rig, options);
  rig.host.start();
  ASSERT_TRUE(rig.host.ask({HostAction::kGravityScale, 0, 0.25}).get());
  writer->set_session({9});
  writer->flush();
  const Result<Checkpoint> read = read_checkpoint(options.file);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read.value().session, Bytes{9});
  EXPECT_TRUE(read.value().state.paused);
  World world = small_world().world();
  ASSERT_TRUE(world.restore(read.value().world));
  EXPECT_EQ(world.gravity_scale(), 0.25);
  rig.host.request_stop();
  rig.host.wait();
}

TEST(Checkpoint, DamagedFallsBackToTheOneBeforeItAndSaysSo) {
  const CheckpointOptions options = checkpoint_options(fresh_folder(), 1e9);
  {
    Rig rig(until(0.05));
    auto writer = checkpoint(rig, options);
    rig.run();
    writer->flush();
  }
  const Result<Checkpoint> whole = read_checkpoint(options.file);
  ASSERT_TRUE(whole);
  EXPECT_GT(whole.value().tick, 0u);
  std::filesystem::resize_file(options.file, std::filesystem::file_size(options.file) - 5);
  const Result<Checkpoint> before = read_checkpoint(options.file);
  ASSERT_TRUE(before) << before.error().text();
  EXPECT_EQ(before.value().tick, 0u) << "that of the start";
  EXPECT_NE(before.value().note.find("cut off"), std::string::npos) << before.value().note;
  std::filesystem::remove(options.file);
  ASSERT_TRUE(read_checkpoint(options.file)) << "a crash between two renames";
  std::filesystem::remove(previous_of(options.file));
  const Result<Checkpoint> none = read_checkpoint(options.file);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text().find("world.checkpoint"), std::string::npos);
}

TEST(Checkpoint, DamagedAnywhereIsAnErrorThatNamesTheFile) {
  const CheckpointOptions options = checkpoint_options(fresh_folder(), 1e9);
  Rig rig(until(0.0));
  auto writer = checkpoint(rig, options);
  const Bytes bytes = read_all(options.file);
  ASSERT_GT(bytes.size(), 1000u);
  const auto read = [](ByteView content) {
    const MemoryFile file(content);
    return read_checkpoint_file(file.get(), "some file");
  };
  ASSERT_TRUE(read(bytes));
  std::mt19937 random(3);
  const auto places = [&](std::size_t count) {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < std::min<std::size_t>(200, bytes.size()); ++i) {
      all.push_back(i);
      all.push_back(bytes.size() - 1 - i);
    }
    while (all.size() < count) all.push_back(random() % bytes.size());
    return all;
  };
  for (const std::size_t length : places(700)) {
    const auto result = read(ByteView(bytes).first(length));
    ASSERT_FALSE(result) << length;
    EXPECT_EQ(result.error().where, "some file");
  }
  for (const std::size_t at : places(700)) {
    Bytes damaged = bytes;
    damaged[at] ^= static_cast<std::uint8_t>(1u << random() % 8);
    EXPECT_FALSE(read(damaged)) << "byte " << at;
  }
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_FALSE(read(longer));
}

TEST(Checkpoint, ThatCannotBeWrittenSaysWhy) {
  CheckpointOptions options;
  options.file = "/proc/nowhere/world";
  Rig rig(until(0.0));
  const auto writer =
      CheckpointWriter::start(small_world().scene, small_world().sampled.spacing, rig.host.start_state(),
                              rig.host.world(), rig.host.state(), options);
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().text().find("/proc/nowhere/world"), std::string::npos);
}

// ---------------------------------------------------------------- recordings

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

TEST(Recording, ThatTheDiskCannotFollowEndsCleanly) {
  RecordingOptions options = recording_options(fresh_folder() / "run");
  options.queue_bytes = 100;  // less than any state
  const Recorded recorded = record(options, 0.3, false);
  EXPECT_NE(recorded.report.totals.ended_early, "");
  auto reader = RecordingReader::open(recorded.file);
  ASSERT_TRUE(reader);
  const Played played = play(*reader.value(), nullptr);
  EXPECT_EQ(played.problem, "");
  EXPECT_TRUE(played.complete) << "its end mark says why";
}

}  // namespace
}  // namespace slosh::keep
