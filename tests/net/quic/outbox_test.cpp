// Stream bytes on their way out.
#include <gtest/gtest.h>

#include <numeric>

#include "net/quic/stream_outbox.h"

namespace slosh::quic {
namespace {

using Shared = std::shared_ptr<const std::vector<std::uint8_t>>;

/// Everything of a stream that is not sent yet, in order; sends it.
std::vector<std::uint8_t> drain(StreamOutbox& outbox, std::int64_t stream, bool& ended) {
  std::vector<std::uint8_t> all;
  ended = false;
  while (outbox.next() == stream) {
    ngtcp2_vec parts[2];
    bool end = false;
    const std::size_t used = outbox.gather(stream, parts, end);
    std::size_t count = 0;
    for (std::size_t i = 0; i < used; ++i) {
      all.insert(all.end(), parts[i].base, parts[i].base + parts[i].len);
      count += parts[i].len;
    }
    outbox.sent(stream, count, end);
    ended = end;
  }
  return all;
}

TEST(StreamOutbox, SharedBytesAreNotCopiedAndGoWhenAcknowledged) {
  constexpr std::size_t kSize = 1 << 20;
  const auto scene = std::make_shared<std::vector<std::uint8_t>>(kSize);
  std::iota(scene->begin(), scene->end(), std::uint8_t{0});
  std::vector<StreamOutbox> connections(150);
  for (StreamOutbox& outbox : connections) {
    ASSERT_TRUE(outbox.push(3, Shared(scene), true, 2 * kSize));
    ngtcp2_vec part[1];
    bool end = false;
    ASSERT_EQ(outbox.gather(3, part, end), 1u);
    EXPECT_EQ(part[0].base, scene->data()) << "the bytes themselves";
    EXPECT_TRUE(end);
  }
  EXPECT_EQ(scene.use_count(), 151);
  for (StreamOutbox& outbox : connections) {
    bool ended = false;
    EXPECT_EQ(drain(outbox, 3, ended), *scene);
    EXPECT_TRUE(ended);
    outbox.acknowledged(3, kSize - 1);
    EXPECT_FALSE(outbox.settled());
    outbox.acknowledged(3, 1);
    EXPECT_TRUE(outbox.settled());
  }
  EXPECT_EQ(scene.use_count(), 1) << "nobody holds on to it any more";
}

TEST(StreamOutbox, SharedAndCopiedBytesKeepTheirOrder) {
  StreamOutbox outbox;
  const std::vector<std::uint8_t> small{1, 2, 3};
  const auto large = std::make_shared<const std::vector<std::uint8_t>>(100'000, std::uint8_t{9});
  ASSERT_TRUE(outbox.push(0, small, false, 1 << 20));
  ASSERT_TRUE(outbox.push(0, large, false, 1 << 20));
  ASSERT_TRUE(outbox.push(0, small, false, 1 << 20));
  ASSERT_TRUE(outbox.push(0, std::make_shared<const std::vector<std::uint8_t>>(), true, 1 << 20));
  EXPECT_FALSE(outbox.push(0, large, false, 1 << 20)) << "after its end";
  EXPECT_FALSE(outbox.push(4, large, false, 100'010)) << "beyond the limit";
  std::vector<std::uint8_t> expected = small;
  expected.insert(expected.end(), large->begin(), large->end());
  expected.insert(expected.end(), small.begin(), small.end());
  bool ended = false;
  EXPECT_EQ(drain(outbox, 0, ended), expected);
  EXPECT_TRUE(ended);
  outbox.acknowledged(0, expected.size());
  EXPECT_TRUE(outbox.settled());
}

}  // namespace
}  // namespace slosh::quic
