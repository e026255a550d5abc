// Replays: all hashes agree, or it is said which does not and how far a damaged recording goes.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "tests/host/recording_kit.h"

namespace slosh::keep {
namespace {

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
  std::vector<Chunk> chunks = chunks_of(recorded.file, 12);
  ASSERT_GT(chunks.size(), 5u);
  chunks[chunks.size() - 2].content.back() ^= 1;
  for (const Chunk& each : chunks) append_chunk(each.type, each.content, other);
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

}  // namespace
}  // namespace slosh::keep
