#include "sim/cpu/cell_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

namespace slosh {
namespace {

TEST(KeySorter, SortsStably) {
  std::mt19937 random(3);
  std::vector<std::uint32_t> keys(5000);
  for (std::uint32_t& key : keys) key = random() % 3000000;
  const std::vector<std::uint32_t> before = keys;
  KeySorter sorter;
  sorter.sort(keys.data(), keys.size(), 3000000);
  EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    EXPECT_EQ(keys[i], before[sorter.order()[i]]);
    if (i > 0 && keys[i] == keys[i - 1]) {
      EXPECT_LT(sorter.order()[i - 1], sorter.order()[i]);
    }
  }
}

TEST(KeySorter, TakesNothingAndOne) {
  KeySorter sorter;
  sorter.sort(nullptr, 0, 100);
  std::uint32_t key = 42;
  sorter.sort(&key, 1, 100);
  EXPECT_EQ(key, 42u);
  EXPECT_EQ(sorter.order()[0], 0u);
}

// Places in bytes as the GPU's density pass subtracts them: nobody in reach is missed, in cubes and slices,
// in cells of the support radius and in larger ones; and a twelfth more than those in reach are taken, not
// twice.
TEST(CellGrid, CoarsePlacesMissNobodyInReach) {
  constexpr float kSupport = 0.1f;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-0.8f, 0.8f);
  for (const double max_cells : {CellGrid::kMaxCells, 1500.0}) {
    const CellGrid cubes(glm::dvec3(-0.81), glm::dvec3(0.83), kSupport, max_cells);
    for (const std::uint32_t slices : {1u, 2u, 4u}) {
      const CellGrid grid = cubes.sliced(slices);
      const int limit = grid.coarse_reach_squared(kSupport);
      int in_reach = 0, taken = 0;
      for (int i = 0; i < 100'000; ++i) {
        const glm::vec3 a{place(random), place(random), place(random)};
        const glm::vec3 b = a + 0.2f * glm::vec3(place(random), place(random), place(random));
        if (!grid.contains(b.x, b.y, b.z)) continue;
        const std::uint32_t cell = grid.cell_of(b.x, b.y, b.z), around = grid.cell_of(a.x, a.y, a.z);
        bool near = false;
        for (std::uint32_t n = 0; n < 9; ++n) {
          const std::uint32_t first = grid.row_around(around, n);
          if (cell < first || cell >= first + grid.row_cells()) continue;
          const std::uint32_t own = grid.coarse_of(a.x, a.y, a.z) | 0x8080u;
          const std::uint32_t from = own + 64u * (1u - n % 3u) + 64u * 256u * (1u - n / 3u);
          const std::uint32_t apart = (from - grid.coarse_of(b.x, b.y, b.z)) ^ 0x8080u;
          int squares = 0;
          for (int byte = 0; byte < 4; ++byte) {
            const auto d = static_cast<std::int8_t>(apart >> 8 * byte);
            squares += d * d;
          }
          near = squares < limit;
        }
        const bool there = glm::distance(a, b) < kSupport;
        EXPECT_TRUE(near || !there) << slices << " slices, " << glm::distance(a, b) << " m";
        in_reach += there;
        taken += near;
      }
      EXPECT_GT(in_reach, 5000);
      EXPECT_LT(taken, (max_cells > 1e6 ? 1.1 : 1.2) * in_reach)
          << slices << " slices, at most " << max_cells << " cells";
    }
  }
}

// The rows around a particle's cell must hold every particle within the support radius, and hold each once.
TEST(CellIndex, RowsHoldEveryNeighborOnce) {
  constexpr double kSupport = 0.1;
  const CellGrid grid(glm::dvec3(-0.5), glm::dvec3(0.5), kSupport);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-0.5f, 0.5f);
  std::vector<glm::vec3> points(3000);
  std::vector<std::uint32_t> keys;
  for (glm::vec3& p : points) {
    p = {place(random), place(random), place(random)};
    keys.push_back(grid.cell_of(p.x, p.y, p.z));
  }
  KeySorter sorter;
  sorter.sort(keys.data(), keys.size(), grid.retired_key());
  CellIndex index;
  index.rebuild(grid, keys.data(), keys.size());
  ASSERT_EQ(index.particles(), points.size());
  for (const CellRun& run : index.runs()) {
    const RowList rows = index.rows(grid, run.cell);
    std::multiset<std::uint32_t> seen;
    for (int row = 0; row < rows.count; ++row) {
      for (std::uint32_t j = rows.rows[row].begin; j < rows.rows[row].end; ++j) seen.insert(j);
    }
    const glm::vec3 p = points[sorter.order()[run.particles.begin]];
    for (std::uint32_t j = 0; j < points.size(); ++j) {
      ASSERT_LE(seen.count(j), 1u);
      if (glm::distance(p, points[sorter.order()[j]]) < kSupport) {
        ASSERT_EQ(seen.count(j), 1u);
      }
    }
  }
}

TEST(CellIndex, RetiredParticlesAreNotIndexed) {
  const CellGrid grid(glm::dvec3(0.0), glm::dvec3(1.0), 0.25);
  const std::uint32_t cell = grid.cell_of(0.5f, 0.5f, 0.5f);
  const std::vector<std::uint32_t> keys{cell, cell, grid.retired_key()};
  CellIndex index;
  index.rebuild(grid, keys.data(), keys.size());
  EXPECT_EQ(index.particles(), 2u);
  index.rebuild(grid, keys.data(), 0);
  EXPECT_EQ(index.particles(), 0u);
  EXPECT_EQ(index.rows(grid, cell).count, 0);
}

TEST(CellGrid, GrowsItsCellsRatherThanTheirNumber) {
  const CellGrid grid(glm::dvec3(-1000.0), glm::dvec3(1000.0), 0.001);
  EXPECT_LE(grid.cell_count(), CellGrid::kMaxCells);
  EXPECT_LT(grid.cell_of(1e30f, -1e30f, 0.0f), grid.cell_count());
}

TEST(CellGrid, SlicesHideNobodyInReach) {
  constexpr float kReach = 0.1f;
  const CellGrid grid = CellGrid(glm::dvec3(-0.3), glm::dvec3(1.0), kReach).sliced(4);
  EXPECT_EQ(grid.row_cells(), 9u);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-0.3f, 1.0f), step(-kReach, kReach);
  int in_reach = 0, seen = 0;
  for (int i = 0; i < 100000; ++i) {
    const glm::vec3 p(place(random), place(random), place(random));
    const glm::vec3 q = p + glm::vec3(step(random), step(random), step(random));
    if (!grid.contains(q.x, q.y, q.z)) continue;
    const std::uint32_t around = grid.cell_of(p.x, p.y, p.z), cell = grid.cell_of(q.x, q.y, q.z);
    bool found = false;
    for (std::uint32_t n = 0; n < 9; ++n)
      found |= cell - grid.row_around(around, n) < grid.row_cells();  // wraps where it lies before
    if (glm::distance(p, q) < kReach) {
      in_reach += 1;
      EXPECT_TRUE(found);
    }
    seen += found;
  }
  EXPECT_GT(in_reach, 40000);
  EXPECT_GE(seen, in_reach);
}

TEST(CellGrid, SlicesAreFewerWhereCellsAreMany) {
  const CellGrid grid = CellGrid(glm::dvec3(-1000.0), glm::dvec3(1000.0), 0.001);
  EXPECT_LE(grid.sliced(64).cell_count(), CellGrid::kMaxSlices);
  EXPECT_EQ(grid.sliced(4).row_cells(), 9u);
}

TEST(CellGrid, KnowsWhatIsOutside) {
  const CellGrid grid(glm::dvec3(0.0), glm::dvec3(1.0), 0.1);
  EXPECT_TRUE(grid.contains(0.5f, 0.5f, 0.5f));
  EXPECT_FALSE(grid.contains(1.5f, 0.5f, 0.5f));
  EXPECT_FALSE(grid.contains(std::numeric_limits<float>::quiet_NaN(), 0.5f, 0.5f));
  EXPECT_FALSE(grid.contains(0.5f, std::numeric_limits<float>::infinity(), 0.5f));
}

}  // namespace
}  // namespace slosh
