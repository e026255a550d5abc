// A disk that is full or may not be written any more: told at once, by its true cause, and what is there
// stays readable.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include "host/keep/replay.h"
#include "tests/host/keep_kit.h"
#include "tests/support/comes.h"

namespace slosh::keep {
namespace {

using test::comes;

/// No file of this process may grow beyond so many bytes while this lives: as a full disk, wherever tests
/// run.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : handler_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &now), 0);
  }
  ~FileLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, handler_);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_{};
  sighandler_t handler_;
};

TEST(FullDisk, ARecordingSaysSoWhileTheWorldGoesOnAndReplaysUpToThere) {
  RecordingOptions options;
  options.file = fresh_folder() / "run";
  options.backend = "cpu";
  options.hash_ticks = 5;
  options.chunk_seconds = 0.0;
  Rig rig(until(1e9));
  auto started = RecordingWriter::start(small_world().scene, small_world().sampled.spacing,
                                        rig.host.start_state(), rig.host.world(), rig.host.state(), options);
  ASSERT_TRUE(started) << started.error().text();
  RecordingWriter& writer = *started.value();
  rig.host.add_tap(writer);
  RecordingReport report;
  {
    const FileLimit limit(std::filesystem::file_size(options.file) + 5000);
    rig.host.start();
    EXPECT_TRUE(comes([&] { return !writer.trouble().empty(); })) << "told while it runs";
    EXPECT_TRUE(rig.host.running());
    const std::uint64_t then = rig.host.progress().tick;
    EXPECT_TRUE(comes([&] { return rig.host.progress().tick > then; })) << "the world goes on";
    rig.host.request_stop();
    rig.host.wait();
    report = writer.finish();
  }
  for (const std::string& why : {writer.trouble(), report.problem, report.totals.ended_early})
    EXPECT_NE(why.find("File too large"), std::string::npos) << "not that the disk is slow: " << why;
  auto opened = Replayer::open(options.file, {1, Backend::kAuto});
  ASSERT_TRUE(opened) << opened.error().text();
  while (true) {
    const Result<bool> stepped = opened.value()->step();
    ASSERT_TRUE(stepped) << stepped.error().text();
    if (!stepped.value()) break;
  }
  EXPECT_GT(opened.value()->verdict().hashes, 0u);
  EXPECT_TRUE(opened.value()->verdict().same(0.01)) << opened.value()->verdict().text(0.01);
}

TEST(FullDisk, NoRecordingBeginsOnIt) {
  RecordingOptions options;
  options.file = "/dev/full";
  Rig rig(until(0.0));
  const auto started =
      RecordingWriter::start(small_world().scene, small_world().sampled.spacing, rig.host.start_state(),
                             rig.host.world(), rig.host.state(), options);
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().text().find("No space left"), std::string::npos) << started.error().text();
}

TEST(FullDisk, ACheckpointSaysSoKeepsTheOldOneAndIsWrittenWhenThereIsRoomAgain) {
  CheckpointOptions options;
  options.file = fresh_folder() / "world";
  options.interval = 0.0;
  Rig rig(until(1e9));
  auto started = CheckpointWriter::start(small_world().scene, small_world().sampled.spacing,
                                         rig.host.start_state(), rig.host.world(), rig.host.state(), options);
  ASSERT_TRUE(started) << started.error().text();
  CheckpointWriter& writer = *started.value();
  rig.host.add_tap(writer);
  {
    const FileLimit limit(std::filesystem::file_size(options.file) / 2);
    rig.host.start();
    EXPECT_TRUE(comes([&] { return !writer.report().problem.empty(); }));
    EXPECT_NE(writer.report().problem.find("File too large"), std::string::npos) << writer.report().problem;
    EXPECT_TRUE(rig.host.running());
    rig.host.request_stop();
    rig.host.wait();
    const Result<Checkpoint> old = read_checkpoint(options.file);
    ASSERT_TRUE(old) << old.error().text();
    EXPECT_EQ(old.value().note, "") << "the half-written one is beside it";
  }
  // Nobody asks for it any more; it is tried again by itself.
  EXPECT_TRUE(comes([&] { return writer.report().problem.empty(); })) << writer.report().problem;
  // What there was room for first may be the world before the last, whose writing was under way then.
  writer.flush();
  const Result<Checkpoint> now = read_checkpoint(options.file);
  ASSERT_TRUE(now) << now.error().text();
  EXPECT_EQ(now.value().tick, rig.host.world().tick());
}

}  // namespace
}  // namespace slosh::keep
