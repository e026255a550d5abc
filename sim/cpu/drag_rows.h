// Who drags whom, and how strongly, written down once a sub-step: implicit viscosity asks dozens of times.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/cpu/simd.h"
#include "sim/math/kernels.h"
#include "sim/particle_view.h"

namespace slosh {

/// Three columns of velocities, m/s, with room for a last batch.
struct VectorColumns {
  Column<float> x, y, z;
  void provide(std::size_t count);
};

/// For each of a set of particles the pairs in which it is dragged. A pair is a vector w along the line
/// between the two, √kg long: over the sub-step the one gets w (w · (v_other − v_own)) N·s. 16 bytes a pair.
class DragRows {
 public:
  /// Begins anew, for particles [0, count) in chunks of `chunk` runs of cells.
  void clear(std::size_t count, std::size_t chunks);

  /// One chunk's rows as they are being written; chunks may be written beside each other.
  class Writer {
   public:
    Writer(DragRows& rows, std::size_t chunk);
    /// The rows of p come now, until the next begin() or the end.
    void begin(std::uint32_t p);
    void end();
    /// The pairs with a batch of particles that begins at `first`, but for those that are 0.
    void add(std::uint32_t first, FloatBatch wx, FloatBatch wy, FloatBatch wz);

   private:
    DragRows& rows_;
    std::uint32_t chunk_, p_ = 0;
  };

  /// N·s on p, which moves by (px, py, pz), by those of `others` that it has pairs with.
  ForceSum<float> drag_on(std::uint32_t p, float px, float py, float pz, const VectorColumns& others) const;

 private:
  struct Chunk {
    std::vector<std::int32_t> other;
    std::vector<float> x, y, z;  // w
    std::uint32_t size = 0;      // of what is written; a batch fits behind it
    void make_room();
  };
  struct Row {
    std::uint32_t chunk = 0, begin = 0, end = 0;
  };
  std::vector<Chunk> chunks_;
  std::vector<Row> rows_;
};

}  // namespace slosh
