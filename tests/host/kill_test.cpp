// What is left on the disk when a host dies between any two of the steps in which it writes: always something
// to carry on from. The system's calls that change files are wrapped by the linker (CMakeLists.txt); a child
// of the test dies in place of one of them.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>

#include "host/keep/secrets.h"
#include "tests/host/keep_kit.h"

namespace {

std::atomic<int> syncs{0};
int calls_left = -1;  // until this process dies; −1: it does not

bool dies_now() {
  return calls_left >= 0 && calls_left-- == 0;
}

constexpr int kDied = 9;

}  // namespace

extern "C" {
// NOLINTBEGIN: the names are the linker's.
int __real_fsync(int);
int __real_link(const char*, const char*);
int __real_rename(const char*, const char*);
int __real_unlink(const char*);
std::size_t __real_fwrite(const void*, std::size_t, std::size_t, std::FILE*);

int __wrap_fsync(int file) {
  if (dies_now()) _exit(kDied);
  syncs += 1;
  return __real_fsync(file);
}
int __wrap_link(const char* from, const char* to) {
  if (dies_now()) _exit(kDied);
  return __real_link(from, to);
}
int __wrap_rename(const char* from, const char* to) {
  if (dies_now()) _exit(kDied);
  return __real_rename(from, to);
}
int __wrap_unlink(const char* path) {
  if (dies_now()) _exit(kDied);
  return __real_unlink(path);
}
std::size_t __wrap_fwrite(const void* data, std::size_t size, std::size_t count, std::FILE* file) {
  if (dies_now()) {
    (void)__real_fwrite(data, size, count / 2, file);
    std::fflush(file);
    _exit(kDied);
  }
  return __real_fwrite(data, size, count, file);
}
// NOLINTEND
}

namespace slosh::keep {
namespace {

/// Does `work` in children that die at their first, second, … call, each in a fresh copy of `folder`, up to
/// the one that lives to its end; after each `check` looks at what it left. How many died.
int kill_at_each_step(const path& folder, const std::function<void(const path&)>& work,
                      const std::function<void(const path&, int)>& check) {
  for (int step = 0; step < 200; ++step) {
    const path here = folder.parent_path() / ("step" + std::to_string(step));
    std::filesystem::copy(folder, here);
    const pid_t child = fork();
    if (child == 0) {
      calls_left = step;
      work(here);
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    check(here, step);
    if (!WIFEXITED(status) || (WEXITSTATUS(status) != 0 && WEXITSTATUS(status) != kDied)) {
      ADD_FAILURE() << "step " << step << " ended with " << status;
      return step;
    }
    if (WEXITSTATUS(status) == 0) return step;
  }
  ADD_FAILURE() << "it never came to its end";
  return -1;
}

CheckpointOptions options_in(const path& folder, Bytes server_state) {
  CheckpointOptions options;
  options.file = folder / "world";
  options.interval = 0.0;
  options.server_state = std::move(server_state);
  options.run = 5;
  return options;
}

void write_one(Rig& rig, const CheckpointOptions& options) {
  (void)CheckpointWriter::start(small_world().scene, small_world().sampled.spacing, rig.host.start_state(),
                                rig.host.world(), rig.host.state(), options);
}

Bytes state_in(const path& file) {
  const Result<std::optional<Secrets>> read = read_secrets(file);
  EXPECT_TRUE(read && read.value()) << file;
  return read && read.value() ? read.value()->server_state : Bytes{};
}

class Killed : public ::testing::Test {
 protected:
  // Two checkpoints on end, of tick 0 and of the run's end.
  void SetUp() override {
    folder_ = fresh_folder() / "kept";
    std::filesystem::create_directory(folder_);
    write_one(rig_, options_in(folder_, {1}));
    rig_.run();
    write_one(rig_, options_in(folder_, {2}));
    ASSERT_EQ(read_checkpoint(folder_ / "world").value().tick, rig_.host.world().tick());
    ASSERT_EQ(read_checkpoint(previous_of(folder_ / "world")).value().tick, 0u);
  }
  Rig rig_{until(0.02)};
  path folder_;
};

TEST_F(Killed, BetweenAnyTwoStepsOfACheckpointItCanBeCarriedOn) {
  const int steps = kill_at_each_step(
      folder_, [&](const path& here) { write_one(rig_, options_in(here, {3})); },
      [&](const path& here, int step) {
        const Result<Checkpoint> read = read_checkpoint(here / "world");
        ASSERT_TRUE(read) << "step " << step << ": " << read.error().text();
        EXPECT_EQ(read.value().note, "") << "step " << step;
        EXPECT_EQ(read.value().tick, rig_.host.world().tick()) << "step " << step;
        EXPECT_GE(state_in(here / "world"), Bytes{2}) << "step " << step;
      });
  EXPECT_GE(steps, 12) << "two files, each written, synced, linked and renamed";
}

TEST_F(Killed, WhileTheNewestIsDamagedTheOneBeforeItStaysUntilThereIsABetterOne) {
  std::filesystem::resize_file(folder_ / "world", 1000);
  std::filesystem::resize_file(secrets_of(folder_ / "world"), 20);
  bool old_one = false, new_one = false;
  kill_at_each_step(
      folder_, [&](const path& here) { write_one(rig_, options_in(here, {3})); },
      [&](const path& here, int step) {
        const Result<Checkpoint> read = read_checkpoint(here / "world");
        ASSERT_TRUE(read) << "step " << step << ": " << read.error().text();
        (read.value().note.empty() ? new_one : old_one) = true;
        EXPECT_NE(state_in(here / "world"), Bytes{2}) << "step " << step;
      });
  EXPECT_TRUE(old_one);
  EXPECT_TRUE(new_one);
}

TEST_F(Killed, BetweenAnyTwoStepsOfSettingAsideOneOfTheTwoPlacesHasItAll) {
  const int steps = kill_at_each_step(
      folder_, [](const path& here) { (void)set_checkpoint_aside(here / "world"); },
      [&](const path& here, int step) {
        int complete = 0;
        for (const path& file : {here / "world", path((here / "world").string() + ".1")}) {
          const Result<Checkpoint> read = read_checkpoint(file);
          const Result<std::optional<Secrets>> secrets = read_secrets(file);
          complete += read && read.value().note.empty() && secrets && secrets.value() &&
                      secrets.value()->note.empty() && secrets.value()->server_state == Bytes{2};
        }
        EXPECT_GE(complete, 1) << "step " << step;
      });
  EXPECT_GE(steps, 10) << "four links, four unlinks, two folders";
}

TEST(Recording, IsBroughtToTheDiskAtItsInterval) {
  const auto syncs_at = [](double seconds) {
    RecordingOptions options;
    options.file = fresh_folder() / "run";
    options.chunk_seconds = 0.0;
    options.sync_seconds = seconds;
    Rig rig(until(0.05));
    const int before = syncs;
    auto writer = RecordingWriter::start(small_world().scene, small_world().sampled.spacing,
                                         rig.host.start_state(), rig.host.world(), rig.host.state(), options);
    rig.host.add_tap(*writer.value());
    rig.run();
    EXPECT_EQ(writer.value()->finish().problem, "");
    return syncs - before;
  };
  EXPECT_EQ(syncs_at(1e9), 2) << "what it begins with, and its end";
  EXPECT_GT(syncs_at(0.0), 10) << "each chunk";
}

TEST_F(Killed, WhatIsSetAsideIsNeverOverwritten) {
  const path file = folder_ / "world";
  const Result<path> first = set_checkpoint_aside(file);
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_EQ(first.value(), file.string() + ".1");
  const Result<path> nothing = set_checkpoint_aside(file);
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing.value(), path()) << "nothing is there any more";
  std::ofstream(previous_of(file)) << "also what cannot be read is not thrown away";
  const Result<path> second = set_checkpoint_aside(file);
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_EQ(second.value(), file.string() + ".2");
  EXPECT_TRUE(std::filesystem::exists(previous_of(second.value())));
  EXPECT_EQ(read_checkpoint(first.value()).value().tick, rig_.host.world().tick());
}

}  // namespace
}  // namespace slosh::keep
