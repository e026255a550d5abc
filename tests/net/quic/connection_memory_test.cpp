// ngtcp2 forgets blocks: they go with the connection. That nothing is left is AddressSanitizer's to say
// (./slosh test --preset asan, where Losses.* leaked 19 kB).
#include "net/quic/connection_memory.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace slosh::quic {
namespace {

TEST(ConnectionMemory, CountsWhatIsTakenAndKeepsContentsOverAResize) {
  ConnectionMemory memory;
  const ngtcp2_mem* f = memory.functions();
  void* forgotten = f->malloc(100, f->user_data);
  std::memset(forgotten, 1, 100);
  auto* cleared = static_cast<unsigned char*>(f->calloc(5, 7, f->user_data));
  for (int i = 0; i < 35; ++i) EXPECT_EQ(cleared[i], 0);
  EXPECT_EQ(memory.blocks(), 2u);
  std::memset(cleared, 7, 35);
  auto* larger = static_cast<unsigned char*>(f->realloc(cleared, 40000, f->user_data));
  for (int i = 0; i < 35; ++i) EXPECT_EQ(larger[i], 7);
  EXPECT_EQ(memory.blocks(), 2u);
  f->free(larger, f->user_data);
  f->free(nullptr, f->user_data);
  EXPECT_EQ(memory.blocks(), 1u);
  void* fresh = f->realloc(nullptr, 8, f->user_data);
  EXPECT_NE(fresh, nullptr);
  EXPECT_EQ(memory.blocks(), 2u);
  EXPECT_EQ(f->calloc(SIZE_MAX / 2, 3, f->user_data), nullptr);
  EXPECT_EQ(f->malloc(SIZE_MAX - 4, f->user_data), nullptr);
  EXPECT_EQ(memory.blocks(), 2u);
}

TEST(ConnectionMemory, BlocksComeAndGoInAnyOrder) {
  ConnectionMemory memory;
  const ngtcp2_mem* f = memory.functions();
  std::vector<void*> blocks;
  for (std::size_t i = 0; i < 100; ++i) blocks.push_back(f->malloc(i, f->user_data));
  for (std::size_t i = 0; i < 100; i += 3) f->free(blocks[i], f->user_data);
  for (std::size_t i = 1; i < 100; i += 3) blocks[i] = f->realloc(blocks[i], 2 * i + 1, f->user_data);
  EXPECT_EQ(memory.blocks(), 66u);
}

}  // namespace
}  // namespace slosh::quic
