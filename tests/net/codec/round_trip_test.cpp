// What goes in comes out: to the lattice point, in every frame, whatever the content.
#include <gtest/gtest.h>

#include <limits>

#include "tests/net/codec/codec_kit.h"

namespace slosh {
namespace {

using codec_kit::rows;
using codec_kit::swirl;

void give(SnapshotDecoder& decoder, const EncodedFrame& frame) {
  for (const Piece& piece : frame.pieces) {
    ASSERT_LE(piece.bytes->size(), 1100u);
    const wire::Fault fault = decoder.take(*piece.bytes);
    ASSERT_FALSE(fault) << fault.text();
  }
}

/// Encodes, decodes and compares every frame; returns bytes.
std::size_t carry(const std::vector<Snapshot>& frames, const CodecOptions& options = {}) {
  SnapshotEncoder encoder(options);
  SnapshotDecoder decoder;
  std::size_t bytes = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const EncodedFrame& encoded = encoder.encode(frames[f], 3);
    bytes += encoded.bytes;
    give(decoder, encoded);
    int given = 0;
    while (const auto got = decoder.next()) {
      ++given;
      EXPECT_EQ(got->frame, f);
      EXPECT_EQ(got->run, 3u);
      EXPECT_NEAR(got->time, frames[f].rigid.time, 1e-6);
      EXPECT_EQ(got->complete, 1.0);
      EXPECT_EQ(rows(*got, options.tolerance), rows(frames[f], options.tolerance)) << "frame " << f;
    }
    EXPECT_EQ(given, encoded.key && f > 0 ? 2 : 1) << "frame " << f;
  }
  return bytes;
}

TEST(RoundTrip, a_swirl_is_exact_to_the_lattice_across_epochs) {
  std::vector<Snapshot> frames;
  for (int f = 0; f < 130; ++f) frames.push_back(swirl(3000, f));
  carry(frames);
}

TEST(RoundTrip, nothing_is_further_off_than_the_tolerance) {
  CodecOptions options;
  SnapshotEncoder encoder(options);
  SnapshotDecoder decoder;
  for (int f = 0; f < 5; ++f) {
    const Snapshot s = swirl(500, f);
    give(decoder, encoder.encode(s, 0));
    const auto got = decoder.next();
    ASSERT_TRUE(got);
    for (const glm::vec3& p : got->positions) {
      const bool near = std::any_of(s.positions.begin(), s.positions.end(), [&](const glm::vec3& q) {
        const glm::vec3 off = glm::abs(p - q);
        return std::max({off.x, off.y, off.z}) <= options.tolerance + 1e-6;
      });
      ASSERT_TRUE(near);
    }
  }
}

TEST(RoundTrip, leaps_noise_and_far_particles_are_exact_too) {
  for (const double noise : {0.0, 0.003, 0.1, 3.0}) {
    std::vector<Snapshot> frames;
    for (int f = 0; f < 8; ++f) frames.push_back(swirl(700, f, noise, 0.5));
    frames[3].positions[5] = {400.0f, -400.0f, 500.0f};
    frames[4].positions[5] = {-400.0f, 400.0f, -500.0f};
    carry(frames);
  }
}

TEST(RoundTrip, a_fine_tolerance_and_a_coarse_one) {
  for (const double tolerance : {0.00005, 0.02}) {
    CodecOptions options;
    options.tolerance = tolerance;
    std::vector<Snapshot> frames;
    for (int f = 0; f < 6; ++f) frames.push_back(swirl(700, f));
    carry(frames, options);
  }
}

TEST(RoundTrip, few_particles_and_all_in_one_place) {
  for (const std::size_t count : {1u, 2u, 127u, 128u, 129u}) {
    std::vector<Snapshot> frames;
    for (int f = 0; f < 4; ++f) frames.push_back(swirl(count, f));
    carry(frames);
    for (Snapshot& s : frames) std::fill(s.positions.begin(), s.positions.end(), glm::vec3(0.25f));
    carry(frames);
  }
}

TEST(RoundTrip, retired_non_finite_and_distant_particles_vanish_where_it_happens) {
  std::vector<Snapshot> frames;
  for (int f = 0; f < 20; ++f) frames.push_back(swirl(1000, f));
  const auto drop = [&](std::size_t from, std::size_t id, glm::vec3 at) {
    for (std::size_t f = from; f < frames.size(); ++f) {
      frames[f].positions[id] = at;
      frames[f].fluid_index[id] = 255;
    }
  };
  for (std::size_t id = 0; id < 300; ++id) drop(3 + id % 9, id, glm::vec3(0.0f));
  carry(frames);

  SnapshotEncoder encoder({});
  SnapshotDecoder decoder;
  Snapshot s = swirl(300, 0);
  give(decoder, encoder.encode(s, 0));
  ASSERT_TRUE(decoder.next());
  s.positions[10].y = std::numeric_limits<float>::quiet_NaN();
  s.positions[11].x = std::numeric_limits<float>::infinity();
  s.positions[12].z = 1e9f;
  give(decoder, encoder.encode(s, 0));
  const auto got = decoder.next();
  ASSERT_TRUE(got);
  EXPECT_EQ(std::count(got->fluid_index.begin(), got->fluid_index.end(), 255), 3);
  for (const glm::vec3& p : got->positions) EXPECT_LT(glm::length(p), 10.0f);
}

TEST(RoundTrip, all_particles_may_retire) {
  std::vector<Snapshot> frames;
  for (int f = 0; f < 6; ++f) frames.push_back(swirl(200, f));
  for (std::size_t f = 2; f < 6; ++f)
    std::fill(frames[f].fluid_index.begin(), frames[f].fluid_index.end(), 255);
  carry(frames);
}

TEST(RoundTrip, another_run_or_number_of_particles_starts_an_epoch) {
  SnapshotEncoder encoder({});
  SnapshotDecoder decoder;
  give(decoder, encoder.encode(swirl(500, 0), 0));
  ASSERT_TRUE(decoder.next());
  EXPECT_FALSE(encoder.encode(swirl(500, 1), 0).key);
  EXPECT_TRUE(encoder.encode(swirl(500, 0), 1).key);
  const EncodedFrame& other = encoder.encode(swirl(600, 1), 1);
  EXPECT_TRUE(other.key);
  give(decoder, other);
  const auto got = decoder.next();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->run, 1u);
  EXPECT_EQ(got->positions.size(), 600u);
  EXPECT_TRUE(encoder.encode(swirl(600, 2), 1, true).key) << "somebody joined";
}

TEST(RoundTrip, the_same_frames_give_the_same_bytes) {
  SnapshotEncoder a({}), b({});
  for (int f = 0; f < 70; ++f) {
    const Snapshot s = swirl(900, f);
    const EncodedFrame& ea = a.encode(s, 0);
    const EncodedFrame& eb = b.encode(s, 0);
    ASSERT_EQ(ea.pieces.size(), eb.pieces.size());
    for (std::size_t p = 0; p < ea.pieces.size(); ++p) ASSERT_EQ(*ea.pieces[p].bytes, *eb.pieces[p].bytes);
  }
}

TEST(RoundTrip, what_rests_costs_almost_nothing) {
  SnapshotEncoder encoder({});
  Snapshot s = swirl(10000, 0);
  encoder.encode(s, 0);
  for (int f = 1; f < 30; ++f) {
    s.rigid.time = f / 60.0;
    EXPECT_LT(encoder.encode(s, 0).bytes, 0.02 * 10000) << "frame " << f;
  }
}

TEST(RoundTrip, only_the_shell_is_sent_where_that_is_asked) {
  CodecOptions options;
  options.shell_only = true;
  SnapshotEncoder encoder(options);
  Snapshot s = swirl(1000, 0);
  s.shell.assign(1000, 0);
  for (std::size_t i = 0; i < 1000; i += 4) s.shell[i] = 1;
  EXPECT_EQ(encoder.encode(s, 0).particles, 250u);
}

}  // namespace
}  // namespace slosh
