// Whom a particle's pressure pushes, and who pushes it, written down once a sub-step: a turn of the solve
// asks for both.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/cpu/drag_rows.h"

namespace slosh {

/// A batch of candidates i of a particle p.
struct PressBatch {
  Vector3<FloatBatch> w;  ///< (−W'/r) (x_p − x_i), without the kernel's constant
  FloatBatch reach;       ///< 0 for those out of reach and for p itself
};

/// What a particle presses by at 1 Pa, K with the kernel's constant, column by column.
struct alignas(16) PressTensor {
  float x[4], y[4], z[4];  ///< in x[3] 1/mass; the other fourths mean nothing
};

/// For each of a set of particles the pairs that press, twice 16 bytes a pair.
class PressureRows {
 public:
  /// Begins anew, for particles [0, count) in chunks of `chunk` runs of cells.
  void clear(std::size_t count, std::size_t chunks);

  /// One chunk's rows as they are being written; chunks may be written beside each other.
  class Writer {
   public:
    Writer(PressureRows& rows, std::size_t chunk);
    /// The rows of p come now, until end().
    void begin(std::uint32_t p) {
      p_ = p;
      count_ = 0;
    }
    /// Of a batch of particles that begins at `first`.
    void add(std::uint32_t first, const PressBatch& pairs) {
      const PickedLanes picked = lanes_above_zero(pairs.reach);
      const int count = count_of(picked);
      if (count == 0) return;
      if (count_ + 2 * kLanes > other_.size()) make_room();
      store_picked(pairs.w.x, picked, x_.data() + count_);
      store_picked(pairs.w.y, picked, y_.data() + count_);
      store_picked(pairs.w.z, picked, z_.data() + count_);
      store_picked_indices(first, picked, other_.data() + count_);
      count_ += static_cast<std::size_t>(count);
    }
    /// `tensors`: one a particle. Returns the sum of what 1 Pa of p pushes it by, m², and in w that of its
    /// square over each neighbour's mass, m⁴/kg.
    Vector4 end(const PressTensor* tensors);

   private:
    __attribute__((noinline)) void make_room();

    PressureRows& rows_;
    std::uint32_t chunk_, p_ = 0;
    std::size_t count_ = 0;  // of one row, in the columns below; there is room for two batches behind it
    std::vector<std::int32_t> other_;
    std::vector<float> x_, y_, z_;
  };

  /// N on p by its neighbours' `pressures`, each three times the same, Pa.
  Vector3<float> push_on(std::uint32_t p, const Vector4* pressures) const;
  /// m³/s: the sum over its neighbours of what 1 Pa of p pushes it by · their velocity.
  float flow_by(std::uint32_t p, const Vector4* velocities) const;

 private:
  // Rows are whole fours: what fills them up is nobody's pair.
  static constexpr std::size_t kTogether = 4;
  struct alignas(16) Pair {
    float x, y, z;
    std::int32_t other;
  };
  struct Chunk {
    Column<Pair> own, other;
    std::size_t size = 0;  // of what is written
  };
  struct Row {
    std::uint32_t chunk = 0, begin = 0, end = 0;
  };
  std::vector<Chunk> chunks_;
  std::vector<Row> rows_;
};

/// What the force pass writes down of fluid particles where pressures are solved for.
struct FluidPress {
  PressureRows rows;
  std::vector<PressTensor> tensors;  ///< one a particle
  std::vector<Vector4>
      own;  ///< what 1 Pa of its own pushes each by, m²: by fluid, walls and bodies; w as Writer::end()

  void clear(std::size_t particles, std::size_t chunks) {
    rows.clear(particles, chunks);
    tensors.resize(particles);
    own.resize(particles);
  }
};

}  // namespace slosh
