// The table of cells that particles on a GPU are counted into: how many cells share an entry.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "render/shader_math.h"

namespace slosh {
namespace {

/// Of a box of cells, the share of those whose entry another has too.
double sharing(const glm::ivec3& low, const glm::ivec3& size, int entries) {
  std::vector<int> cells(static_cast<std::size_t>(entries), 0);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) ++cells.at(shader::entry_of(low + glm::ivec3(x, y, z), entries));
    }
  }
  int shared = 0;
  for (const int here : cells) shared += here > 1 ? here : 0;
  return static_cast<double>(shared) / (static_cast<double>(size.x) * size.y * size.z);
}

// What is deep in the fluid is told by one cell an entry: a cell whose entry another has counts as not
// filled, and so all round it are drawn. By a hash the 2632 cells of a dam had 1632 entries, and of its 36
// thousand particles 97 % were drawn for 54 %.
TEST(CellTable, CellsOfOnePieceOfFluidHardlyShareAnEntry) {
  for (const glm::ivec3& low : {glm::ivec3(-11, 0, -6), glm::ivec3(0), glm::ivec3(-1000, 700, -300)}) {
    // Twelve entries a cell, as the table of 33 thousand particles has.
    EXPECT_EQ(sharing(low, {21, 11, 11}, 32768), 0.0);
    EXPECT_EQ(sharing(low, {45, 30, 27}, 524288), 0.0);
    EXPECT_EQ(sharing(low, {80, 13, 80}, 1048576), 0.0);
    EXPECT_EQ(sharing(low, {9, 35, 9}, 32768), 0.0);
    EXPECT_EQ(sharing(low, {102, 5, 5}, 32768), 0.0);
    // A sheet two cells high.
    EXPECT_LT(sharing(low, {37, 2, 37}, 32768), 0.08);
  }
}

TEST(CellTable, CellsAlongXFollowEachOther) {
  const auto first = shader::entry_of(glm::ivec3(-3, 5, -7), 1024);
  for (int x = 0; x < 8; ++x)
    EXPECT_EQ(shader::entry_of(glm::ivec3(x - 3, 5, -7), 1024), (first + x) & 1023u);
}

}  // namespace
}  // namespace slosh
