// Which of the candidates around a cell its particles can meet at all.
#pragma once

#include <algorithm>
#include <bit>

#include "sim/passes/pressure_force/row_force.h"

namespace slosh {

/// The box around a cell's particles. Bodies' particles are thin on the ground: of the cells beside them half
/// hold none in reach, and of their rows a part.
class CellBox {
 public:
  CellBox(const NeighborColumns& own, ParticleRange range)
      : x_(own.x, range), y_(own.y, range), z_(own.z, range) {}

  /// `rows` of n from the first to the last in reach; `h`: within which, m, where n has no reach of its own.
  RowList in_reach(const NeighborColumns& n, const RowList& rows, float h) const {
    RowList found;
    for (int row = 0; row < rows.count; ++row) {
      const ParticleRange range = rows.rows[row];
      std::uint32_t first = range.end, last = range.begin;
      for (std::uint32_t j = range.begin; j < range.end; j += kLanes) {
        const FloatBatch reach = n.reach ? FloatBatch::load_unaligned(n.reach + j) : FloatBatch(h);
        const FloatBatch dx = x_.off(n.x + j), dy = y_.off(n.y + j), dz = z_.off(n.z + j);
        PickedLanes picked = lanes_less(dx * dx + dy * dy + dz * dz, reach * reach);
        if (range.end - j < kLanes) picked &= (PickedLanes{1} << (range.end - j)) - 1;
        if (!picked) continue;
        if (first == range.end) first = j + static_cast<std::uint32_t>(std::countr_zero(picked));
        last = j + static_cast<std::uint32_t>(std::bit_width(picked));
      }
      if (first < last) found.rows[found.count++] = {first, last};
    }
    return found;
  }

 private:
  // Of one axis.
  struct Side {
    Side(const float* all, ParticleRange range) {
      float least = all[range.begin], most = least;
      for (std::uint32_t p = range.begin + 1; p < range.end; ++p) {
        least = std::min(least, all[p]);
        most = std::max(most, all[p]);
      }
      low = FloatBatch(least);
      high = FloatBatch(most);
    }
    // How far outside each is.
    FloatBatch off(const float* x) const {
      const FloatBatch at = FloatBatch::load_unaligned(x);
      return RealOps<FloatBatch>::positive_part(xsimd::max(low - at, at - high));
    }
    FloatBatch low, high;
  };
  Side x_, y_, z_;
};

/// Bodies' particles that fluid of one cell can meet.
struct NearRows {
  bool around = false;  ///< some are in the cells around
  RowList fixed, moving;

  bool empty() const { return fixed.count + moving.count == 0; }
  void find(const CellGrid& grid, const FluidParticles& fluid, const CellRun& run,
            const BoundaryParticles& all_fixed, const BoundaryParticles& all_moving) {
    fixed = all_fixed.index.rows(grid, run.cell);
    moving = all_moving.index.rows(grid, run.cell);
    around = !empty();
    if (!around) return;
    const CellBox box(columns(fluid), run.particles);
    fixed = box.in_reach(columns(all_fixed), fixed, 0.0f);
    moving = box.in_reach(columns(all_moving), moving, 0.0f);
  }
};

}  // namespace slosh
