// Sorting particles by cell on the CPU, and finding the rows of cells around one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/neighbours/cell_grid.h"

namespace slosh {

/// A contiguous range of sorted particles.
struct ParticleRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// An occupied cell and its particles.
struct CellRun {
  std::uint32_t cell = 0;
  ParticleRange particles;
};

/// The non-empty rows around a cell.
struct RowList {
  std::array<ParticleRange, 9> rows;
  int count = 0;
};

/// Where each cell's particles are in one sorted set.
class CellIndex {
 public:
  /// sorted_keys: the cell of each particle, rising; entries >= grid.retired_key() are left out.
  void rebuild(const CellGrid& grid, const std::uint32_t* sorted_keys, std::size_t count);

  const std::vector<CellRun>& runs() const { return runs_; }
  std::size_t particles() const { return runs_.empty() ? 0 : runs_.back().particles.end; }
  RowList rows(const CellGrid& grid, std::uint32_t cell) const;

 private:
  // An empty cell is {max, 0}, so that a row is the minimum of the begins and the maximum of the ends.
  static constexpr ParticleRange kEmpty{0xffffffffu, 0};
  std::vector<ParticleRange> cells_;
  std::vector<CellRun> runs_;
};

/// Stable radix sort of keys. After the call order[i] is the old index of the i-th particle and keys is
/// sorted.
class KeySorter {
 public:
  void sort(std::uint32_t* keys, std::size_t count, std::uint32_t largest_key);
  const std::uint32_t* order() const { return order_.data(); }

 private:
  std::vector<std::uint64_t> items_, scratch_;
  std::vector<std::uint32_t> order_;
};

}  // namespace slosh
