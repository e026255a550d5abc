// The blocks and the hands of a file on disk: bitwise, or damage that is told.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "host/keep/recording.h"
#include "tests/host/keep_kit.h"

namespace slosh::keep {
namespace {

TEST(Chunks, AreTheBytesThatFilesAlreadyHave) {
  const char text[] = "123456789";
  Bytes file;
  append_chunk(1, {reinterpret_cast<const std::uint8_t*>(text), 9}, file);
  Bytes wanted{1, 0, 0, 0, 9, 0, 0, 0, 9, 0, 0, 0, 0xa8, 0xe5, 0x00, 0x15};
  wanted.insert(wanted.end(), text, text + 9);
  EXPECT_EQ(file, wanted) << "stored, for it is no smaller packed; CRC-32 as zip has it";
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

}  // namespace
}  // namespace slosh::keep
