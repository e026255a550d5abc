// Walking over rows of sorted neighbours a SIMD batch at a time.
#pragma once

#include "sim/cpu/cell_grid.h"
#include "sim/cpu/simd.h"

namespace slosh {

/// Calls f(j, weight) for each batch that begins at j; the weight is 1 in the lanes that count, else 0.
template <class F>
void for_each_batch(const RowList& rows, F&& f) {
  for (int row = 0; row < rows.count; ++row) {
    const ParticleRange range = rows.rows[row];
    std::uint32_t j = range.begin;
    for (; j + kLanes <= range.end; j += kLanes) f(j, FloatBatch(1.0f));
    if (j < range.end) f(j, first_lanes(range.end - j));
  }
}

}  // namespace slosh
