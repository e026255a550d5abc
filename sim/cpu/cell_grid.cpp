#include "sim/cpu/cell_grid.h"

#include <algorithm>
#include <bit>

namespace slosh {

void CellIndex::rebuild(const CellGrid& grid, const std::uint32_t* sorted_keys, std::size_t count) {
  if (cells_.size() != grid.cell_count() + 1) {
    cells_.assign(grid.cell_count() + 1, kEmpty);
  } else {
    // Clearing what was occupied costs the particles; clearing everything would cost the room.
    for (const CellRun& run : runs_) cells_[run.cell] = kEmpty;
  }
  runs_.clear();
  const std::uint32_t retired = grid.retired_key();
  std::uint32_t begin = 0;
  while (begin < count && sorted_keys[begin] < retired) {
    const std::uint32_t cell = sorted_keys[begin];
    std::uint32_t end = begin + 1;
    while (end < count && sorted_keys[end] == cell) ++end;
    cells_[cell] = {begin, end};
    runs_.push_back({cell, {begin, end}});
    begin = end;
  }
}

RowList CellIndex::rows(const CellGrid& grid, std::uint32_t cell) const {
  RowList list;
  if (runs_.empty()) return list;
  for (std::uint32_t n = 0; n < 9; ++n) {
    const ParticleRange* c = cells_.data() + grid.row_around(cell, n);
    const std::uint32_t begin = std::min({c[0].begin, c[1].begin, c[2].begin});
    const std::uint32_t end = std::max({c[0].end, c[1].end, c[2].end});
    if (begin < end) list.rows[list.count++] = {begin, end};
  }
  return list;
}

void KeySorter::sort(std::uint32_t* keys, std::size_t count, std::uint32_t largest_key) {
  items_.resize(count);
  scratch_.resize(count);
  order_.resize(count);
  for (std::size_t i = 0; i < count; ++i) items_[i] = (static_cast<std::uint64_t>(keys[i]) << 32) | i;
  constexpr int kDigitBits = 11;
  constexpr std::size_t kBuckets = std::size_t{1} << kDigitBits;
  std::array<std::uint32_t, kBuckets> start;
  const int key_bits = std::bit_width(largest_key);
  for (int shift = 32; shift < 32 + key_bits; shift += kDigitBits) {
    start.fill(0);
    for (const std::uint64_t item : items_) ++start[(item >> shift) & (kBuckets - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& bucket : start) {
      const std::uint32_t size = bucket;
      bucket = sum;
      sum += size;
    }
    for (const std::uint64_t item : items_) scratch_[start[(item >> shift) & (kBuckets - 1)]++] = item;
    items_.swap(scratch_);
  }
  for (std::size_t i = 0; i < count; ++i) {
    keys[i] = static_cast<std::uint32_t>(items_[i] >> 32);
    order_[i] = static_cast<std::uint32_t>(items_[i]);
  }
}

}  // namespace slosh
