// Pieces to snapshots with the real codec: films, windows, gaps, two streams.
#include "peer/remote/snapshot_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr double kFrame = 1.0 / 60.0;  // s between snapshots

/// A block of fluid that drifts evenly; its body too.
struct Drift {
  std::size_t side = 12;
  glm::vec3 place(std::size_t i, double time) const {
    const std::size_t x = i % side;
    const std::size_t y = i / side % side;
    const std::size_t z = i / (side * side);
    return glm::vec3(0.01 * static_cast<double>(x) + 0.2 * time, 0.01 * static_cast<double>(y),
                     0.01 * static_cast<double>(z) - 0.1 * time);
  }
  Snapshot at(double time) const {
    Snapshot s;
    s.rigid.time = time;
    for (std::size_t i = 0; i < side * side * side; ++i) {
      s.positions.push_back(place(i, time));
      s.fluid_index.push_back(0);
    }
    return s;
  }
};

BodyMessage bodies(double time, std::uint32_t run = 0) {
  BodyMessage m;
  m.run = run;
  m.bodies.time = time;
  m.bodies.bodies.resize(1);
  m.bodies.bodies[0].pose.position.x = 3.0 * time;
  return m;
}

/// Offers frame k at time k / 60, but for those that `lost` names.
template <class Lost>
void play(SnapshotMaker& maker, SnapshotEncoder& encoder, const Drift& drift, int first, int last, Lost lost,
          std::uint32_t run = 0) {
  for (int k = first; k <= last; ++k) {
    const double time = kFrame * (k - first) + kFrame * first * (run == 0 ? 1.0 : 0.0);
    const EncodedFrame& frame = encoder.encode(drift.at(time), run, k == first);
    maker.note_bodies(bodies(time, run));
    if (lost(k)) continue;
    for (const Piece& piece : frame.pieces) maker.offer(*piece.bytes);
  }
}

void expect_drift(const Snapshot& snapshot, const Drift& drift, float tolerance) {
  const double time = snapshot.rigid.time;
  ASSERT_EQ(snapshot.positions.size(), drift.side * drift.side * drift.side);
  EXPECT_NEAR(snapshot.rigid.bodies[0].pose.position.x, 3.0 * time, 1e-9);
  glm::dvec3 mean(0.0);
  glm::dvec3 truth(0.0);
  float off = 0.0f;  // m, at most
  for (std::size_t i = 0; i < snapshot.positions.size(); ++i) {
    mean += glm::dvec3(snapshot.positions[i]);
    truth += glm::dvec3(drift.place(i, time));
    // The drift takes every particle from its own place on the lattice: none is far from one.
    const glm::vec3 start = snapshot.positions[i] - drift.place(0, time);
    for (int axis = 0; axis < 3; ++axis) {
      const float cell = start[axis] / 0.01f;
      off = std::max(off, 0.01f * std::abs(cell - std::round(cell)));
    }
  }
  EXPECT_LT(off, tolerance) << time;
  const double count = static_cast<double>(snapshot.positions.size());
  EXPECT_LT(glm::length(mean - truth) / count, tolerance);
}

SnapshotMakerOptions film(double frames_per_second) {
  SnapshotMakerOptions options;
  options.film = true;
  options.frames_per_second = frames_per_second;
  return options;
}

std::vector<SnapshotPointer> all(SnapshotQueue& queue) {
  std::vector<SnapshotPointer> snapshots;
  while (SnapshotPointer snapshot = queue.pop(std::chrono::milliseconds(0))) snapshots.push_back(snapshot);
  return snapshots;
}

TEST(SnapshotMaker, AFilmHasEachMomentOnceAndExactly) {
  const Drift drift;
  SnapshotQueue queue(std::size_t{1} << 30);
  SnapshotMaker maker(film(25.0), queue);  // no multiple of the snapshots' rate
  CodecOptions codec;
  codec.epoch_seconds = 0.5;  // several epochs
  SnapshotEncoder encoder(codec);
  play(maker, encoder, drift, 3, 123, [](int) { return false; });
  maker.finish();
  const std::vector<SnapshotPointer> snapshots = all(queue);
  ASSERT_EQ(snapshots.size(), 50u) << "2.05 s at 25 a second, from the first multiple at or after 0.05 s";
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    EXPECT_NEAR(snapshots[i]->rigid.time, (static_cast<double>(i) + 2.0) / 25.0, 1e-9);
    expect_drift(*snapshots[i], drift, 0.0021f);
  }
  EXPECT_TRUE(queue.finished());
  const SnapshotReport report = maker.report();
  EXPECT_EQ(report.refused, 0u);
  EXPECT_EQ(report.shown, 50u);
  EXPECT_EQ(report.frames, report.whole);
}

TEST(SnapshotMaker, LostSnapshotsLeaveNoGapInTheFilm) {
  const Drift drift;
  SnapshotQueue queue(std::size_t{1} << 30);
  SnapshotMaker maker(film(30.0), queue);
  CodecOptions codec;
  codec.epoch_seconds = 0.5;
  SnapshotEncoder encoder(codec);
  play(maker, encoder, drift, 0, 120, [](int k) { return k % 7 == 3; });
  maker.finish();
  const std::vector<SnapshotPointer> snapshots = all(queue);
  ASSERT_GE(snapshots.size(), 59u);
  for (std::size_t i = 1; i < snapshots.size(); ++i) {
    EXPECT_NEAR(snapshots[i]->rigid.time - snapshots[i - 1]->rigid.time, 1.0 / 30.0, 1e-9);
    EXPECT_FALSE(snapshots[i]->positions.empty());
  }
}

/// A peer whose machine is busy: everything came in time, and the thread that decodes has hardly begun.
TEST(SnapshotMaker, WhatWaitsToBeDecodedIsNotMissingInTheFilm) {
  Drift drift;
  drift.side = 30;  // a frame takes much longer to decode than to come
  constexpr int kFrames = 150;
  SnapshotEncoder encoder(CodecOptions{});
  std::vector<std::vector<SharedBytes>> pieces(kFrames);
  for (int k = 0; k < kFrames; ++k) {
    for (const Piece& piece : encoder.encode(drift.at(kFrame * k), 0, k == 0).pieces) {
      pieces[static_cast<std::size_t>(k)].push_back(piece.bytes);
    }
  }
  SnapshotQueue queue(std::size_t{1} << 30);
  SnapshotMaker maker(film(30.0), queue);
  const auto come = [&](int first, int end) {
    for (int k = first; k < end; ++k) {
      maker.note_bodies(bodies(kFrame * k));
      for (const SharedBytes& piece : pieces[static_cast<std::size_t>(k)]) maker.offer(*piece);
    }
  };
  come(0, 30);
  while (maker.report().frames < 10) std::this_thread::sleep_for(std::chrono::microseconds(100));
  come(30, kFrames);
  maker.finish();
  const std::vector<SnapshotPointer> snapshots = all(queue);
  ASSERT_EQ(snapshots.size(), 75u) << "2.48 s at 30 a second";
  for (const SnapshotPointer& snapshot : snapshots) expect_drift(*snapshot, drift, 0.0021f);
}

TEST(SnapshotMaker, ParticlesThatDoNotComeAreNotWaitedForLongerThanASecond) {
  const Drift drift;
  SnapshotQueue queue(std::size_t{1} << 30);
  SnapshotMaker maker(film(30.0), queue);
  SnapshotEncoder encoder(CodecOptions{});
  play(maker, encoder, drift, 0, 60, [](int) { return false; });
  for (int k = 61; k <= 180; ++k) maker.note_bodies(bodies(kFrame * k));
  while (queue.waiting() < 60) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // 1.97 s of it
  EXPECT_LE(queue.waiting(), 61u) << "of 3 s of body states";
  maker.finish();
  EXPECT_EQ(all(queue).size(), 91u);
}

TEST(SnapshotMaker, AnotherStreamTakesOverWhenItHasAFrame) {
  const Drift drift;
  Drift fewer;
  fewer.side = 8;
  SnapshotQueue queue(std::size_t{1} << 30);
  SnapshotMaker maker(film(30.0), queue);
  CodecOptions fine;
  fine.stream = 1;
  CodecOptions coarse;
  coarse.stream = 3;
  SnapshotEncoder first(fine);
  SnapshotEncoder second(coarse);
  play(maker, first, drift, 0, 30, [](int) { return false; });
  play(maker, second, fewer, 31, 60, [](int) { return false; });
  maker.finish();
  const std::vector<SnapshotPointer> snapshots = all(queue);
  ASSERT_EQ(snapshots.size(), 31u);
  EXPECT_EQ(snapshots.front()->positions.size(), 12u * 12 * 12);
  EXPECT_EQ(snapshots.back()->positions.size(), 8u * 8 * 8);
  for (std::size_t i = 18; i < snapshots.size(); ++i) expect_drift(*snapshots[i], fewer, 0.0021f);
}

TEST(SnapshotMaker, AResetStartsTheFilmsTimeAnew) {
  const Drift drift;
  SnapshotQueue queue(std::size_t{1} << 30);
  SnapshotMaker maker(film(30.0), queue);
  SnapshotEncoder encoder(CodecOptions{});
  play(maker, encoder, drift, 0, 60, [](int) { return false; });
  while (queue.waiting() < 20) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  play(
      maker, encoder, drift, 0, 60, [](int) { return false; }, 1);
  maker.finish();
  const std::vector<SnapshotPointer> snapshots = all(queue);
  EXPECT_GT(snapshots.size(), 50u);
  EXPECT_NEAR(snapshots.back()->rigid.time, 1.0, 1.0 / 30.0);
  int backs = 0;
  for (std::size_t i = 1; i < snapshots.size(); ++i) {
    backs += snapshots[i]->rigid.time < snapshots[i - 1]->rigid.time ? 1 : 0;
  }
  EXPECT_EQ(backs, 1);
}

TEST(SnapshotMaker, AWindowIsGivenTheMomentThatIsDue) {
  const Drift drift;
  SnapshotQueue queue(std::size_t{1} << 30);
  SnapshotMaker maker({}, queue);
  SnapshotEncoder encoder(CodecOptions{});
  EXPECT_EQ(maker.newest(steady_now_ns()), nullptr) << "nothing came yet";
  play(maker, encoder, drift, 0, 60, [](int) { return false; });
  WorldMoment moment;
  moment.time = 0.5;
  moment.stamp_ns = steady_now_ns();
  moment.known = true;  // it stands still at half a second
  maker.note_moment(moment);
  SnapshotPointer snapshot;
  for (int i = 0; i < 10000 && !snapshot; ++i) {
    snapshot = maker.newest(steady_now_ns());
    if (!snapshot) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_NE(snapshot, nullptr);
  while (maker.report().frames < 61) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  // What came in between may still change the snapshot of that moment; then it is the same again and not
  // given.
  int unchanged = 0;
  for (int i = 0; i < 1000 && unchanged < 20; ++i) {
    if (SnapshotPointer later = maker.newest(steady_now_ns())) {
      snapshot = later;
      unchanged = 0;
    } else {
      unchanged += 1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(unchanged, 20);
  EXPECT_NEAR(snapshot->rigid.time, 0.5, 1e-9);
  expect_drift(*snapshot, drift, 0.0021f);
}

TEST(SnapshotMaker, NoiseIsRefusedAndCounted) {
  SnapshotQueue queue(std::size_t{1} << 20);
  SnapshotMaker maker({}, queue);
  for (int i = 0; i < 500; ++i) {
    std::vector<std::uint8_t> noise(static_cast<std::size_t>(i));
    for (std::size_t k = 0; k < noise.size(); ++k) noise[k] = static_cast<std::uint8_t>(i * 31 + k * k);
    maker.offer(noise);
  }
  maker.finish();
  EXPECT_GT(maker.report().refused, 400u);
}

}  // namespace
}  // namespace slosh
