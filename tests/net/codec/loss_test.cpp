// Pieces that are lost, doubled, late and in any order; and pieces that somebody made up.
#include <gtest/gtest.h>

#include "tests/net/codec/codec_kit.h"

namespace slosh {
namespace {

using codec_kit::rows;
using codec_kit::swirl;

constexpr double kTolerance = 0.001;
using Datagrams = std::vector<std::vector<std::uint8_t>>;

Datagrams datagrams(const EncodedFrame& frame) {
  Datagrams out;
  for (const Piece& piece : frame.pieces) out.push_back(*piece.bytes);
  return out;
}

/// A world whose shell is another tenth of it every six frames, and what a shell stream has then.
Snapshot changing_shell(std::size_t count, int frame) {
  Snapshot s = swirl(count, frame);
  s.shell.resize(count);
  for (std::size_t i = 0; i < count; ++i) s.shell[i] = (i + static_cast<std::size_t>(frame / 6)) % 10 < 3;
  return s;
}

/// A host that mends what feedback of `delay` frames ago asked for, twice, over a link that loses a share.
void carry_over_loss(double loss, int frames, unsigned seed) {
  SnapshotEncoder encoder({});
  SnapshotDecoder decoder;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> chance;
  std::vector<Snapshot> truth;
  std::vector<std::vector<wire::BlockRange>> asked;
  constexpr std::size_t kDelay = 4;
  int exact_at_the_end = 0;
  for (int f = 0; f < frames; ++f) {
    const bool lossy = f < frames - 20;
    truth.push_back(swirl(4000, f));
    Datagrams sent = datagrams(encoder.encode(truth.back(), 0));
    for (const std::size_t ago : {kDelay, kDelay + 1}) {
      if (asked.size() < ago) continue;
      std::vector<Piece> mended;
      encoder.mend(asked[asked.size() - ago], mended);
      for (const Piece& piece : mended) sent.push_back(*piece.bytes);
    }
    for (const auto& datagram : sent) {
      if (lossy && chance(random) < loss) continue;
      ASSERT_FALSE(decoder.take(datagram));
    }
    while (const auto got = decoder.next(1)) {
      ASSERT_LT(got->frame, truth.size());
      if (got->complete < 1.0) continue;
      ASSERT_EQ(rows(*got, kTolerance), rows(truth[got->frame], kTolerance)) << "frame " << got->frame;
      if (f >= frames - 5) ++exact_at_the_end;
    }
    asked.push_back(decoder.feedback().missing);
  }
  EXPECT_GE(exact_at_the_end, 4) << "loss " << loss << ", seed " << seed;
}

TEST(Loss, mending_always_leads_back_to_the_exact_picture) {
  for (const double loss : {0.02, 0.2, 0.6}) {
    for (const unsigned seed : {1u, 2u}) carry_over_loss(loss, 50, seed);
  }
}

/// An epoch that grows, over a link that loses a share: whatever is whole is what a peer without loss has,
/// new blocks that were missed are asked for, and all comes back to the exact picture.
TEST(Loss, an_epoch_that_grows_is_mended_too) {
  for (const double loss : {0.0, 0.05, 0.4}) {
    CodecOptions options;
    options.shell_only = true;
    SnapshotEncoder encoder(options);
    SnapshotDecoder decoder, spared;
    std::mt19937 random(9);
    std::uniform_real_distribution<double> chance;
    std::vector<std::vector<codec_kit::Row>> truth;
    std::vector<std::vector<wire::BlockRange>> asked;
    std::uint32_t most_blocks = 0, first_blocks = 0;
    int exact_at_the_end = 0;
    bool missed_new = false;
    for (int f = 0; f < 55; ++f) {  // one epoch
      const Snapshot world = changing_shell(4000, f);
      const EncodedFrame& encoded = encoder.encode(world, 0);
      ASSERT_EQ(encoded.epoch, 0u);
      if (f == 0) first_blocks = encoded.blocks;
      most_blocks = std::max(most_blocks, encoded.blocks);
      Datagrams sent = datagrams(encoded);
      for (const auto& d : sent) ASSERT_FALSE(spared.take(d));
      const auto whole = spared.next(0);
      ASSERT_TRUE(whole);
      ASSERT_EQ(whole->complete, 1.0);
      ASSERT_TRUE(spared.feedback().missing.empty());
      truth.push_back(rows(*whole, kTolerance));
      const auto all = rows(world, kTolerance);
      ASSERT_TRUE(std::includes(all.begin(), all.end(), truth.back().begin(), truth.back().end()));
      for (const std::size_t ago : {3u, 4u}) {
        if (asked.size() < ago) continue;
        std::vector<Piece> mended;
        encoder.mend(asked[asked.size() - ago], mended);
        for (const Piece& piece : mended) sent.push_back(*piece.bytes);
      }
      if (f % 4 == 1) std::shuffle(sent.begin(), sent.end(), random);
      for (const auto& d : sent) {
        if (f < 35 && chance(random) < loss) continue;
        const wire::Fault fault = decoder.take(d);
        ASSERT_FALSE(fault) << fault.text();
      }
      while (const auto got = decoder.next(1)) {
        if (got->complete < 1.0) continue;
        ASSERT_EQ(rows(*got, kTolerance), truth[got->frame]) << "frame " << got->frame;
        exact_at_the_end += f >= 50;
      }
      asked.push_back(decoder.feedback().missing);
      for (const wire::BlockRange& range : asked.back()) missed_new |= range.first >= first_blocks;
    }
    EXPECT_GT(most_blocks, first_blocks + 3);
    EXPECT_GE(exact_at_the_end, 4) << "loss " << loss;
    EXPECT_EQ(missed_new, loss > 0.0) << "loss " << loss;
  }
}

TEST(Loss, order_and_doubles_do_not_matter_within_the_window) {
  SnapshotEncoder encoder({});
  SnapshotDecoder decoder;
  std::mt19937 random(3);
  std::vector<Snapshot> truth;
  for (int f = 0; f < 66; f += 3) {
    Datagrams sent;
    for (int i = 0; i < 3; ++i) {
      truth.push_back(swirl(4000, f + i));
      for (auto& datagram : datagrams(encoder.encode(truth.back(), 0))) {
        sent.push_back(datagram);
        sent.push_back(std::move(datagram));
      }
    }
    std::shuffle(sent.begin(), sent.end(), random);
    for (const auto& datagram : sent) ASSERT_FALSE(decoder.take(datagram));
    std::uint64_t last = 0;
    int given = 0;
    while (const auto got = decoder.next(100)) {
      EXPECT_GE(got->frame, last);
      last = got->frame;
      ++given;
      EXPECT_EQ(got->complete, 1.0);
      EXPECT_EQ(rows(*got, kTolerance), rows(truth[got->frame], kTolerance));
    }
    EXPECT_GE(given, 3);
    EXPECT_TRUE(decoder.feedback().missing.empty());
  }
}

TEST(Loss, who_joins_late_needs_one_key_frame) {
  SnapshotEncoder encoder({});
  for (int f = 0; f < 10; ++f) encoder.encode(swirl(4000, f), 0);
  SnapshotDecoder decoder;
  EXPECT_FALSE(decoder.next());
  for (const auto& d : datagrams(encoder.encode(swirl(4000, 10), 0, true))) ASSERT_FALSE(decoder.take(d));
  const auto got = decoder.next();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->complete, 1.0);
  EXPECT_EQ(rows(*got, kTolerance), rows(swirl(4000, 10), kTolerance));
}

TEST(Loss, a_mending_piece_alone_shows_the_newest_frame) {
  SnapshotEncoder encoder({});
  SnapshotDecoder decoder;
  for (const auto& d : datagrams(encoder.encode(swirl(100, 0), 0))) ASSERT_FALSE(decoder.take(d));
  ASSERT_TRUE(decoder.next());
  for (int f = 1; f < 50; ++f) encoder.encode(swirl(100, f), 0);
  std::vector<Piece> mended;
  const wire::BlockRange all{0, 1};
  encoder.mend({&all, 1}, mended);
  for (const Piece& p : mended) ASSERT_FALSE(decoder.take(*p.bytes));
  const auto got = decoder.next();
  ASSERT_TRUE(got);
  EXPECT_EQ(rows(*got, kTolerance), rows(swirl(100, 49), kTolerance));
}

// Damage within raw bits passes for other particles: that bytes come as they were sent is the transport's
// work. What is refused must leave everything as it was: the same decoder goes on exactly.
TEST(Hostile, refused_pieces_are_told_in_words_and_change_nothing) {
  SnapshotEncoder encoder({});
  SnapshotDecoder decoder;
  std::mt19937 random(5);
  std::size_t refused = 0;
  Datagrams history;
  for (int f = 0; f < 8; ++f) {
    const Snapshot s = swirl(1500, f);
    const Datagrams sent = datagrams(encoder.encode(s, 0));
    for (int i = 0; i < 40; ++i) {
      auto bad = sent[random() % sent.size()];
      if (i % 3 == 0)
        bad.resize(random() % bad.size());
      else
        bad[random() % bad.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
      SnapshotDecoder judge;
      for (const auto& d : history) judge.take(d);
      const wire::Fault expected = judge.take(bad);
      if (!expected) continue;
      ++refused;
      EXPECT_FALSE(expected.field.empty());
      EXPECT_EQ(decoder.take(bad).text(), expected.text());
    }
    for (const auto& d : sent) {
      ASSERT_FALSE(decoder.take(d));
      history.push_back(d);
    }
    const auto got = decoder.next();
    ASSERT_TRUE(got);
    EXPECT_EQ(rows(*got, kTolerance), rows(s, kTolerance));
    EXPECT_TRUE(decoder.feedback().missing.empty());
  }
  EXPECT_GT(refused, 100u);
}

TEST(Hostile, any_bytes_at_all_are_survived) {
  SnapshotEncoder encoder({});
  std::mt19937 random(11);
  Datagrams real;
  for (int f = 0; f < 4; ++f) {
    for (auto& d : datagrams(encoder.encode(swirl(700, f), 0))) real.push_back(d);
  }
  for (int round = 0; round < 20; ++round) {
    SnapshotDecoder decoder;
    for (int i = 0; i < 300; ++i) {
      auto bad = real[random() % real.size()];
      const int changes = static_cast<int>(random() % 6);
      for (int c = 0; c < changes; ++c)
        bad[1 + random() % std::min<std::size_t>(bad.size() - 1, 60)] = static_cast<std::uint8_t>(random());
      if (random() % 8 == 0) bad.resize(random() % bad.size());
      decoder.take(bad);
      if (i % 10 == 0) {
        while (const auto got = decoder.next()) ASSERT_LE(got->positions.size(), std::size_t{1} << 22);
        decoder.feedback();
      }
    }
  }
}

}  // namespace
}  // namespace slosh
