// Who drags whom, and how strongly, written down once a sub-step: implicit viscosity asks dozens of times.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/cpu/simd.h"
#include "sim/math/kernels.h"
#include "sim/math/symmetric.h"
#include "sim/particle_view.h"

namespace slosh {

inline Symmetric<FloatBatch> no_rate() {
  const FloatBatch z(0.0f);
  return {z, z, z, z, z, z};
}

inline Symmetric<float> summed(const Symmetric<FloatBatch>& s) {
  return {lane_sum(s.xx), lane_sum(s.xy), lane_sum(s.xz), lane_sum(s.yy), lane_sum(s.yz), lane_sum(s.zz)};
}

/// A vector of a particle's in 16 bytes, so that a neighbour's is one load. `w` means nothing.
struct alignas(16) Vector4 {
  float x = 0.0f, y = 0.0f, z = 0.0f, w = 0.0f;
};

/// A batch of candidates: d from each to the particle, m, and q, kg/m²: over the sub-step it drags the
/// particle by q d (d · v), N·s, v their velocity less the particle's. q is 0 out of reach.
struct PairBatch {
  FloatBatch x, y, z;  // d
  FloatBatch r_squared;
  FloatBatch q;
};

/// For each of a set of particles the pairs in which it is dragged. A pair is a vector w = √q d, √kg long:
/// over the sub-step the one gets w (w · (v_other − v_own)) N·s. 16 bytes a pair.
class DragRows {
 public:
  /// Begins anew, for particles [0, count) in chunks of `chunk` runs of cells.
  void clear(std::size_t count, std::size_t chunks);

  /// One chunk's rows as they are being written; chunks may be written beside each other.
  class Writer {
   public:
    Writer(DragRows& rows, std::size_t chunk);
    /// The rows of p come now, until end().
    void begin(std::uint32_t p) {
      p_ = p;
      count_ = 0;
    }
    /// The pairs with a batch of particles that begins at `first`, but for those out of reach and p itself.
    /// Of some two hundred candidates thirty are: the rest of the work is end()'s, on whole batches of those.
    void add(std::uint32_t first, const PairBatch& pairs) {
      const PickedLanes picked = lanes_above_zero(pairs.q * pairs.r_squared);
      const int count = count_of(picked);
      if (count == 0) return;
      if (count_ + 2 * kLanes > other_.size()) make_room();
      store_picked(pairs.x, picked, x_.data() + count_);
      store_picked(pairs.y, picked, y_.data() + count_);
      store_picked(pairs.z, picked, z_.data() + count_);
      store_picked(pairs.q, picked, q_.data() + count_);
      store_picked_indices(first, picked, other_.data() + count_);
      count_ += static_cast<std::size_t>(count);
    }
    /// The sum of w wᵀ over the row, kg.
    Symmetric<float> end();

   private:
    __attribute__((noinline)) void make_room();

    DragRows& rows_;
    std::uint32_t chunk_, p_ = 0;
    std::size_t count_ = 0;  // of one row, in the columns below; there is room for two batches behind it
    std::vector<std::int32_t> other_;
    std::vector<float> x_, y_, z_, q_;
  };

  /// N·s on p by those of `velocities` that it has pairs with, all moving by these, itself by `own`.
  ForceSum<float> drag_on(std::uint32_t p, const Vector4& own, const Vector4* velocities) const;

 private:
  // Rows are whole fours: what fills them up is nobody's pair.
  static constexpr std::size_t kTogether = 4;
  struct alignas(16) Pair {
    float x, y, z;  // w
    std::int32_t other;
  };
  struct Chunk {
    Column<Pair> pairs;
    std::size_t size = 0;  // of what is written
  };
  struct Row {
    std::uint32_t chunk = 0, begin = 0, end = 0;
  };
  std::vector<Chunk> chunks_;
  std::vector<Row> rows_;
};

}  // namespace slosh
