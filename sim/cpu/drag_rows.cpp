#include "sim/cpu/drag_rows.h"

#include <algorithm>

namespace slosh {

void VectorColumns::provide(std::size_t count) {
  for (Column<float>* column : {&x, &y, &z}) {
    if (column->size() < count + kLanes) column->assign(count + kLanes, 0.0f);
  }
}

void DragRows::clear(std::size_t count, std::size_t chunks) {
  rows_.assign(count, Row{});
  if (chunks_.size() < chunks) chunks_.resize(chunks);
  for (Chunk& chunk : chunks_) chunk.size = 0;
}

void DragRows::Chunk::make_room() {
  if (size + 2 * kLanes <= other.size()) return;
  const std::size_t room = std::max<std::size_t>(4096, 2 * other.size());
  other.resize(room);
  for (std::vector<float>* column : {&x, &y, &z}) column->resize(room);
}

DragRows::Writer::Writer(DragRows& rows, std::size_t chunk)
    : rows_(rows), chunk_(static_cast<std::uint32_t>(chunk)) {}

void DragRows::Writer::begin(std::uint32_t p) {
  p_ = p;
  rows_.rows_[p].chunk = chunk_;
  rows_.rows_[p].begin = rows_.chunks_[chunk_].size;
}

// Rows are whole batches: what fills them up is nobody's pair.
void DragRows::Writer::end() {
  Chunk& chunk = rows_.chunks_[chunk_];
  chunk.make_room();
  for (; chunk.size % kLanes != 0; ++chunk.size) {
    chunk.other[chunk.size] = 0;
    chunk.x[chunk.size] = chunk.y[chunk.size] = chunk.z[chunk.size] = 0.0f;
  }
  rows_.rows_[p_].end = chunk.size;
}

void DragRows::Writer::add(std::uint32_t first, FloatBatch wx, FloatBatch wy, FloatBatch wz) {
  const PickedLanes picked = lanes_above_zero(wx * wx + wy * wy + wz * wz);
  const int count = count_of(picked);
  if (count == 0) return;
  Chunk& chunk = rows_.chunks_[chunk_];
  chunk.make_room();
  store_picked(wx, picked, chunk.x.data() + chunk.size);
  store_picked(wy, picked, chunk.y.data() + chunk.size);
  store_picked(wz, picked, chunk.z.data() + chunk.size);
  store_picked_indices(first, picked, chunk.other.data() + chunk.size);
  chunk.size += static_cast<std::uint32_t>(count);
}

ForceSum<float> DragRows::drag_on(std::uint32_t p, float px, float py, float pz,
                                  const VectorColumns& others) const {
  using Index = xsimd::batch<std::int32_t>;
  const Row& row = rows_[p];
  const Chunk& chunk = chunks_[row.chunk];
  const FloatBatch vx(px), vy(py), vz(pz);
  FloatBatch fx(0.0f), fy(0.0f), fz(0.0f);
  for (std::uint32_t k = row.begin; k < row.end; k += kLanes) {
    const Index other = Index::load_unaligned(chunk.other.data() + k);
    const FloatBatch wx = FloatBatch::load_unaligned(chunk.x.data() + k);
    const FloatBatch wy = FloatBatch::load_unaligned(chunk.y.data() + k);
    const FloatBatch wz = FloatBatch::load_unaligned(chunk.z.data() + k);
    const FloatBatch along = wx * (FloatBatch::gather(others.x.data(), other) - vx) +
                             wy * (FloatBatch::gather(others.y.data(), other) - vy) +
                             wz * (FloatBatch::gather(others.z.data(), other) - vz);
    fx += wx * along;
    fy += wy * along;
    fz += wz * along;
  }
  return {lane_sum(fx), lane_sum(fy), lane_sum(fz)};
}

}  // namespace slosh
