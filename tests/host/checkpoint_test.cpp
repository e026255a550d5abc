// Checkpoints: what is on the disk is the world, bitwise, or an error in words.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <random>
#include <thread>

#include "host/keep/rebuild.h"
#include "host/keep/secrets.h"
#include "tests/host/keep_kit.h"

namespace slosh::keep {
namespace {

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

Bytes server_state_of(const path& file) {
  const Result<std::optional<Secrets>> secrets = read_secrets(file);
  EXPECT_TRUE(secrets && secrets.value()) << file;
  return secrets && secrets.value() ? secrets.value()->server_state : Bytes{};
}

constexpr long kHead = 8;  // bytes before the first chunk

TEST(Checkpoint, ResumedIsTheRunThatWasNeverStopped) {
  CheckpointOptions options = checkpoint_options(fresh_folder());
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
  options.task_done = [] { return std::vector<double>{1.5, 2.25}; };
  auto writer = checkpoint(rig, options);
  writer->set_server_state({1, 2, 3});
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
  EXPECT_EQ(server_state_of(options.file), (Bytes{1, 2, 3}));
  EXPECT_EQ(c.state.task_done, (std::vector<double>{1.5, 2.25}));
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

/// Waits until the writer has copied the world so many times.
bool wait_for_copies(const CheckpointWriter& writer, std::uint64_t copies) {
  for (int i = 0; i < 2000 && writer.report().copies < copies; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return writer.report().copies >= copies;
}

TEST(Checkpoint, AHundredCommandsCopyTheWorldAtTheInterval) {
  const CheckpointOptions options = checkpoint_options(fresh_folder(), 1.0);
  HostOptions host = until(1e9);
  host.paused = true;
  Rig rig(host);
  auto writer = checkpoint(rig, options);
  rig.host.start();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 500; ++i)
    ASSERT_TRUE(rig.host.ask({HostAction::kGravityScale, 0, 0.001 * (i + 1)}).get());
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::uint64_t copies = writer->report().copies;
  std::printf("500 commands in %.2f s: %llu copies of the world\n", took,
              static_cast<unsigned long long>(copies));
  EXPECT_LE(static_cast<double>(copies), took / options.interval + 1.0);
  ASSERT_TRUE(wait_for_copies(*writer, copies + 1)) << "the last one is kept too, while the world stands";
  writer->flush();
  const Result<Checkpoint> read = read_checkpoint(options.file);
  ASSERT_TRUE(read) << read.error().text();
  World world = small_world().world();
  ASSERT_TRUE(world.restore(read.value().world));
  EXPECT_EQ(world.gravity_scale(), 0.5);
  rig.host.request_stop();
  rig.host.wait();
}

TEST(Checkpoint, OfAStandingWorldFollowsTheServerAndTheSwitches) {
  const CheckpointOptions options = checkpoint_options(fresh_folder(), 0.02);
  HostOptions host = until(1e9);
  host.paused = true;
  Rig rig(host);
  auto writer = checkpoint(rig, options);
  rig.host.start();
  ASSERT_TRUE(rig.host.ask({HostAction::kGravityScale, 0, 0.25}).get());
  ASSERT_TRUE(wait_for_copies(*writer, 1));
  writer->set_server_state({9});
  writer->flush();
  const Result<Checkpoint> read = read_checkpoint(options.file);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(server_state_of(options.file), Bytes{9});
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
  for (const char* part : {"cut off", "of 0.00 s", "what came after is lost"})
    EXPECT_NE(before.value().note.find(part), std::string::npos) << before.value().note;
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

TEST(Checkpoint, HoldsNoSecretAndTheSecretsBesideItAreTheOwnersAlone) {
  CheckpointOptions options = checkpoint_options(fresh_folder(), 1e9);
  std::mt19937 random(5);
  for (int i = 0; i < 64; ++i) options.server_state.push_back(static_cast<std::uint8_t>(random()));
  options.run = 77;
  options.place = {"127.0.0.1:5000", {"203.0.113.7:5000"}};
  Rig rig(until(0.0));
  auto writer = checkpoint(rig, options);
  // Right after the start, as a crash then would find them.
  const Result<Checkpoint> read = read_checkpoint(options.file);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read.value().run, 77u);
  EXPECT_EQ(read.value().place.listen, options.place.listen);
  EXPECT_EQ(read.value().place.addresses, options.place.addresses);
  EXPECT_EQ(server_state_of(options.file), options.server_state);
  EXPECT_EQ(server_state_of(previous_of(options.file)), options.server_state) << "of the one before it too";
  const std::vector<Chunk> chunks = chunks_of(options.file, kHead);
  ASSERT_GE(chunks.size(), 5u);
  for (const Chunk& chunk : chunks) {
    const auto found = std::search(chunk.content.begin(), chunk.content.end(), options.server_state.begin(),
                                   options.server_state.begin() + 16);
    EXPECT_EQ(found, chunk.content.end()) << "in part " << int{chunk.type};
  }
  struct stat facts{};
  ASSERT_EQ(::stat(secrets_of(options.file).c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0600u);
}

TEST(Checkpoint, OfAnEarlierFormatIsNamedAndSecretsThatAreDamagedFallBack) {
  CheckpointOptions options = checkpoint_options(fresh_folder(), 1e9);
  options.server_state = {1};
  Rig rig(until(0.0));
  auto writer = checkpoint(rig, options);
  writer->set_server_state({2});
  writer->flush();
  const path secrets = secrets_of(options.file);
  std::filesystem::resize_file(secrets, std::filesystem::file_size(secrets) - 1);
  const Result<std::optional<Secrets>> before = read_secrets(options.file);
  ASSERT_TRUE(before && before.value());
  EXPECT_EQ(before.value()->server_state, Bytes{1});
  EXPECT_NE(before.value()->note.find("cut off"), std::string::npos) << before.value()->note;
  std::filesystem::resize_file(previous_of(secrets), 3);
  const Result<std::optional<Secrets>> none = read_secrets(options.file);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text().find("new links"), std::string::npos) << none.error().text();
  std::filesystem::remove(secrets);
  std::filesystem::remove(previous_of(secrets));
  const Result<std::optional<Secrets>> missing = read_secrets(options.file);
  ASSERT_TRUE(missing);
  EXPECT_FALSE(missing.value().has_value());

  const auto read_as = [&](std::uint8_t format) {
    Bytes old;
    for (Chunk chunk : chunks_of(options.file, kHead)) {
      if (chunk.type == 3) {
        chunk.content.front() = format;  // the head begins with it
        chunk.content.pop_back();        // and ends with the steps of a task that are done: none
      }
      append_chunk(chunk.type, chunk.content, old);
    }
    const Bytes now = read_all(options.file);
    old.insert(old.begin(), now.begin(), now.begin() + 8);
    const MemoryFile file(old);
    return read_checkpoint_file(file.get(), "old");
  };
  const Result<Checkpoint> second = read_as(2);
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_TRUE(second.value().state.task_done.empty());
  const Result<Checkpoint> read = read_as(1);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().text().find("format 1, and this program reads format 3"), std::string::npos)
      << read.error().text();
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

}  // namespace
}  // namespace slosh::keep
