// Recordings: what is on the disk runs again bitwise, or an error says where it does not.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "tests/host/recording_kit.h"

namespace slosh::keep {
namespace {

TEST(Recording, RunsAgainToTheBitThroughResetsAndChanges) {
  const Recorded recorded = record(recording_options(fresh_folder() / "run"), 0.4, true);
  EXPECT_EQ(recorded.report.problem, "");
  EXPECT_EQ(recorded.report.totals.ended_early, "");
  EXPECT_EQ(recorded.report.totals.changes, 6u);
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

TEST(Recording, ThatGoesOnBehindItsEndSaysSo) {
  const Recorded recorded = record(recording_options(fresh_folder() / "run"), 0.05, false);
  const Bytes bytes = read_all(recorded.file);
  for (const std::size_t more : {std::size_t{1}, std::size_t{100}, bytes.size()}) {
    Bytes longer = bytes;
    for (std::size_t i = 0; i < more; ++i) longer.push_back(more == bytes.size() ? bytes[i] : 'x');
    const MemoryFile file(longer);
    auto reader = RecordingReader::open(file.get(), "long");
    ASSERT_TRUE(reader) << reader.error().text();
    const Played played = play(*reader.value(), nullptr);
    EXPECT_EQ(played.steps, recorded.report.totals.steps) << "what is there is played";
    EXPECT_FALSE(played.complete);
    EXPECT_NE(played.problem.find("it is the recording's last, and something follows it"), std::string::npos)
        << played.problem;
    EXPECT_NE(played.problem.find("What comes before is whole"), std::string::npos) << played.problem;
  }
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
  for (Chunk chunk : chunks_of(recorded.file, 12)) {
    if (chunk.type == 1) {  // the head ends with how many there are, and them
      ASSERT_EQ(small_world().scene.fluids.size(), 1u);
      chunk.content.resize(chunk.content.size() - 8);
      ASSERT_EQ(chunk.content.back(), 1u);
      chunk.content.back() = 0;
    }
    append_chunk(chunk.type, chunk.content, old);
  }
  const MemoryFile file(old);
  auto reader = RecordingReader::open(file.get(), "old");
  ASSERT_TRUE(reader) << reader.error().text();
  EXPECT_EQ(play(*reader.value(), nullptr).steps, recorded.report.totals.steps);
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
