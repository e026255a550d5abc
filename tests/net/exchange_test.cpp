// The lock-free exchanges between two threads. Run under ThreadSanitizer too (preset tsan).
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>
#include <vector>

#include "net/ring.h"
#include "net/triple_buffer.h"

namespace slosh {
namespace {

TEST(TripleBuffer, ShowsNothingNewUntilPublished) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.front(), 7);
  buffer.back() = 8;
  EXPECT_FALSE(buffer.update());
  buffer.publish();
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.front(), 8);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.front(), 8);
}

TEST(TripleBuffer, KeepsOnlyTheNewest) {
  TripleBuffer<int> buffer(0);
  for (int i = 1; i <= 10; ++i) {
    buffer.back() = i;
    buffer.publish();
  }
  EXPECT_TRUE(buffer.update());
  EXPECT_EQ(buffer.front(), 10);
}

TEST(TripleBuffer, NeverTearsBetweenThreads) {
  // A value of many words, all the same: a torn read would show two different ones.
  using Value = std::array<std::uint64_t, 64>;
  TripleBuffer<Value> buffer(Value{});
  constexpr std::uint64_t kLast = 20000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      buffer.back().fill(i);
      buffer.publish();
    }
  });
  std::uint64_t seen = 0;
  bool torn = false;
  bool back_in_time = false;
  while (seen != kLast) {
    if (!buffer.update()) continue;
    const Value& value = buffer.front();
    for (const std::uint64_t word : value) torn |= word != value[0];
    back_in_time |= value[0] <= seen;
    seen = value[0];
  }
  writer.join();
  EXPECT_FALSE(torn);
  EXPECT_FALSE(back_in_time);
}

TEST(Ring, RefusesWhenFullAndKeepsOrder) {
  Ring<int> ring(3);
  EXPECT_TRUE(ring.push(1));
  EXPECT_TRUE(ring.push(2));
  EXPECT_TRUE(ring.push(3));
  EXPECT_FALSE(ring.push(4));
  int value = 0;
  for (const int expected : {1, 2, 3}) {
    ASSERT_TRUE(ring.pop(value));
    EXPECT_EQ(value, expected);
  }
  EXPECT_FALSE(ring.pop(value));
}

TEST(Ring, PassesEverythingInOrderBetweenThreads) {
  Ring<std::uint64_t> ring(64);
  constexpr std::uint64_t kCount = 100000;
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kCount;) {
      if (ring.push(i)) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 0; expected < kCount;) {
    std::uint64_t value = 0;
    if (!ring.pop(value)) {
      std::this_thread::yield();
      continue;
    }
    wrong += value != expected;
    ++expected;
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace slosh
