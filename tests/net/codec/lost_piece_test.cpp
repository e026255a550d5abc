// What a peer shows when single, given pieces are lost: what carries on, how far off it is at most, and when
// all is whole again.
#include <gtest/gtest.h>

#include "net/codec/lattice.h"
#include "tests/net/codec/codec_kit.h"

namespace slosh {
namespace {

using codec_kit::swirl;

constexpr double kLostTolerance = 0.001;
constexpr std::size_t kParticles = 20000;  // several pieces a frame
constexpr double kTurn = 0.02;             // rad a frame, and up to 15 % more
// Of a particle of the swirl: a circle of at most 0.15·√2 m at 1.15 · kTurn.
constexpr double kSpeed = 0.2122 * 1.15 * kTurn;         // m a frame
constexpr double kAcceleration = kSpeed * 1.15 * kTurn;  // m a frame²

/// One stream to two peers: `spared` gets everything, `peer` all but what a test takes out.
struct Link {
  SnapshotEncoder encoder{CodecOptions{}};
  SnapshotDecoder spared, peer;
  std::vector<DecodedFrame> exact, shown;  // the newest of each call to next()
  std::vector<std::vector<wire::BlockRange>> asked;
  EncodedFrame newest;

  /// Sends the next frame without the pieces for which `lost` says so, with what was asked `delay` frames ago
  /// and the frame before that; 0: nothing is mended.
  template <class Lost>
  void send(std::size_t delay, Lost&& lost) {
    const int frame = static_cast<int>(asked.size());
    newest = encoder.encode(swirl(kParticles, frame, 0.0, kTurn), 0);
    for (std::size_t p = 0; p < newest.pieces.size(); ++p) {
      ASSERT_FALSE(spared.take(*newest.pieces[p].bytes));
      if (!lost(p)) ASSERT_FALSE(peer.take(*newest.pieces[p].bytes));
    }
    for (const std::size_t ago : {delay, delay + 1}) {
      if (delay == 0 || asked.size() < ago) continue;
      std::vector<Piece> mended;
      encoder.mend(asked[asked.size() - ago], mended);
      for (const Piece& piece : mended) ASSERT_FALSE(peer.take(*piece.bytes));
    }
    while (auto got = spared.next(0)) exact.push_back(std::move(*got));
    while (auto got = peer.next(0)) shown.push_back(std::move(*got));
    asked.push_back(peer.feedback().missing);
    ASSERT_EQ(exact.size(), shown.size());
  }
  void send() {
    send(0, [](std::size_t) { return false; });
  }
  void send_mending(std::size_t delay) {
    send(delay, [](std::size_t) { return false; });
  }
  bool whole() const {
    return shown.back().complete == 1.0 && shown.back().positions == exact.back().positions &&
           shown.back().fluid_index == exact.back().fluid_index;
  }
};

/// How many of the particles shown are off, and that none is by more than `most` m along any axis.
std::size_t count_off(const DecodedFrame& shown, const DecodedFrame& exact, double most) {
  EXPECT_EQ(shown.positions.size(), exact.positions.size());
  std::size_t off = 0;
  double worst = 0.0;
  for (std::size_t i = 0; i < shown.positions.size(); ++i) {
    if (shown.fluid_index[i] == 255) continue;
    const glm::vec3 distance = glm::abs(shown.positions[i] - exact.positions[i]);
    off += shown.positions[i] != exact.positions[i];
    worst = std::max<double>(worst, std::max({distance.x, distance.y, distance.z}));
  }
  EXPECT_LE(worst, most);
  return off;
}
std::size_t not_drawn(const DecodedFrame& frame) {
  return static_cast<std::size_t>(std::count(frame.fluid_index.begin(), frame.fluid_index.end(), 255));
}

/// A block that moves on by its last motion for n frames misses its change of velocity, n (n + 1) / 2 times
/// a frame's; rounding of the two frames that it goes by, and of the truth, comes to it.
double carried_off(double frames) {
  return 0.5 * frames * (frames + 1.0) * kAcceleration + (2.0 + 2.0 * frames) * kLostTolerance + 1e-6;
}

TEST(LostPiece, its_blocks_move_on_until_mended_and_the_rest_is_exact) {
  constexpr std::size_t kDelay = 4;
  Link link;
  for (int f = 0; f < 10; ++f) {
    link.send_mending(kDelay);
    ASSERT_TRUE(link.whole()) << "frame " << f;
  }
  Piece lost;
  link.send(kDelay, [&](std::size_t p) {
    if (p == 1) lost = link.newest.pieces[p];
    return p == 1;
  });
  ASSERT_FALSE(link.newest.key);
  ASSERT_GT(link.newest.pieces.size(), 2u);
  ASSERT_GT(lost.blocks, 1u);
  for (std::size_t n = 1; n <= kDelay; ++n) {
    // All pieces after it arrive, but build on what is missing.
    const DecodedFrame& shown = link.shown.back();
    EXPECT_EQ(shown.frame, 9 + n);
    EXPECT_NEAR(shown.complete, 1.0 - lost.blocks * codec::kBlock / double(kParticles), 0.03);
    EXPECT_EQ(not_drawn(shown), 0u);
    const std::size_t off = count_off(shown, link.exact.back(), carried_off(double(n)));
    EXPECT_GT(off, 0u);
    EXPECT_LE(off, lost.blocks * codec::kBlock);
    link.send_mending(kDelay);
  }
  // Frames 14 and 15 are mended, from 16 on temporal pieces do.
  for (int f = 14; f < 25; ++f) {
    EXPECT_EQ(link.shown.back().frame, static_cast<std::uint64_t>(f));
    EXPECT_TRUE(link.whole()) << "frame " << f;
    EXPECT_TRUE(f < 15 || link.asked.back().empty()) << "frame " << f;
    link.send_mending(kDelay);
  }
}

TEST(LostPiece, without_mending_its_blocks_stand_in_time_and_the_next_epoch_is_whole) {
  Link link;
  for (int f = 0; f < 10; ++f) link.send();
  link.send(0, [](std::size_t p) { return p == 0; });
  int frames = 1;
  while (!link.newest.key) {
    EXPECT_FALSE(link.whole());
    EXPECT_FALSE(link.asked.back().empty()) << "it keeps asking";
    // 0.3 s on and then still: 18 frames of motion, and the truth goes on.
    const double still = std::max(0.0, frames - 18.0);
    EXPECT_GT(count_off(link.shown.back(), link.exact.back(),
                        carried_off(std::min(frames, 18)) + still * kSpeed * (1.0 + 18 * 1.15 * kTurn)),
              0u);
    link.send();
    ++frames;
    ASSERT_LT(frames, 70);
  }
  EXPECT_TRUE(link.whole());
  link.send();
  EXPECT_TRUE(link.whole());
}

TEST(LostPiece, of_the_same_blocks_twice_costs_no_more_than_once) {
  constexpr std::size_t kDelay = 3;
  Link link;
  for (int f = 0; f < 10; ++f) link.send_mending(kDelay);
  for (int f = 10; f < 12; ++f) link.send(kDelay, [](std::size_t p) { return p == 0; });
  while (link.shown.back().frame < 10 + kDelay) link.send_mending(kDelay);
  EXPECT_TRUE(link.whole());
}

TEST(LostPiece, of_a_key_frame_is_not_drawn_until_mended) {
  constexpr std::size_t kDelay = 4;
  Link link;
  Piece lost;
  link.send(kDelay, [&](std::size_t p) {
    if (p == 2) lost = link.newest.pieces[p];
    return p == 2;
  });
  ASSERT_TRUE(link.newest.key);
  ASSERT_GT(link.newest.pieces.size(), 3u);
  // Nobody knows where these are. All others are exact.
  EXPECT_EQ(not_drawn(link.shown.back()), lost.blocks * codec::kBlock);
  EXPECT_EQ(count_off(link.shown.back(), link.exact.back(), 0.0), 0u);
  while (!link.whole()) {
    link.send_mending(kDelay);
    // What shares a temporal piece with them and comes behind stands where it was.
    const auto n = static_cast<double>(link.shown.back().frame);
    count_off(link.shown.back(), link.exact.back(), n * kSpeed + 2.0 * kLostTolerance);
    EXPECT_LE(not_drawn(link.shown.back()), lost.blocks * codec::kBlock);
    // The first frame's loss is told with the second frame, and mended a delay after that at the latest.
    ASSERT_LE(link.shown.back().frame, 1 + kDelay + 1);
  }
  EXPECT_EQ(not_drawn(link.shown.back()), 0u);
  for (int f = 0; f < 5; ++f) {
    link.send_mending(kDelay);
    EXPECT_TRUE(link.whole());
  }
}

}  // namespace
}  // namespace slosh
