#include "sim/cpu/drag_rows.h"

#include <algorithm>
#include <cstring>

#include "sim/cpu/four_vectors.h"

namespace slosh {

namespace {

Four load(const Vector4& v) {
  return four_at(&v.x);
}

void add_outer(FloatBatch x, FloatBatch y, FloatBatch z, Symmetric<FloatBatch>& sum) {
  sum.xx += x * x;
  sum.xy += x * y;
  sum.xz += x * z;
  sum.yy += y * y;
  sum.yz += y * z;
  sum.zz += z * z;
}

}  // namespace

void DragRows::clear(std::size_t count, std::size_t chunks) {
  rows_.assign(count, Row{});
  if (chunks_.size() < chunks) chunks_.resize(chunks);
  for (Chunk& chunk : chunks_) chunk.size = 0;
}

DragRows::Writer::Writer(DragRows& rows, std::size_t chunk)
    : rows_(rows), chunk_(static_cast<std::uint32_t>(chunk)) {
  make_room();
}

void DragRows::Writer::make_room() {
  const std::size_t room = std::max<std::size_t>(256, 2 * other_.size());
  other_.resize(room);
  for (std::vector<float>* column : {&x_, &y_, &z_, &q_}) column->resize(room);
}

Symmetric<float> DragRows::Writer::end() {
  Chunk& chunk = rows_.chunks_[chunk_];
  const std::size_t whole = (count_ + kTogether - 1) / kTogether * kTogether;
  // Whole batches are written: what lies behind the row is the next one's.
  if (chunk.size + whole + kLanes > chunk.pairs.size())
    chunk.pairs.resize(std::max<std::size_t>({4096, 2 * chunk.pairs.size(), chunk.size + whole + kLanes}));
  Pair* pairs = chunk.pairs.data() + chunk.size;
  for (std::vector<float>* column : {&x_, &y_, &z_, &q_})
    FloatBatch(0.0f).store_unaligned(column->data() + count_);
  std::fill_n(other_.begin() + static_cast<std::ptrdiff_t>(count_), kLanes, 0);
  Symmetric<FloatBatch> rate = no_rate();
  for (std::size_t k = 0; k < count_; k += kLanes) {
    const FloatBatch w = xsimd::sqrt(FloatBatch::load_unaligned(q_.data() + k));
    const FloatBatch x = w * FloatBatch::load_unaligned(x_.data() + k);
    const FloatBatch y = w * FloatBatch::load_unaligned(y_.data() + k);
    const FloatBatch z = w * FloatBatch::load_unaligned(z_.data() + k);
    add_outer(x, y, z, rate);
    alignas(64) float wx[kLanes], wy[kLanes], wz[kLanes];
    x.store_aligned(wx);
    y.store_aligned(wy);
    z.store_aligned(wz);
    for (std::size_t i = 0; i < kLanes; ++i) pairs[k + i] = {wx[i], wy[i], wz[i], other_[k + i]};
  }
  rows_.rows_[p_] = {chunk_, static_cast<std::uint32_t>(chunk.size),
                     static_cast<std::uint32_t>(chunk.size + whole)};
  chunk.size += whole;
  return summed(rate);
}

ForceSum<float> DragRows::drag_on(std::uint32_t p, const Vector4& own, const Vector4* velocities) const {
  const Row& row = rows_[p];
  const Pair* const pairs = chunks_[row.chunk].pairs.data();
  const SixteenBits of_w = {-1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0};
  const Four self = load(own);
  const Sixteen v = side_by_side(self, self, self, self);
  Sixteen sum = {};
  for (std::uint32_t k = row.begin; k < row.end; k += kTogether) {
    const Pair* four = pairs + k;
    SixteenBits bits;
    std::memcpy(&bits, four, sizeof bits);
    const auto w = reinterpret_cast<Sixteen>(bits & of_w);
    const Sixteen others = side_by_side(load(velocities[four[0].other]), load(velocities[four[1].other]),
                                        load(velocities[four[2].other]), load(velocities[four[3].other]));
    Sixteen along = w * (others - v);  // in its fourth 0
    along += __builtin_shufflevector(along, along, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
    along += __builtin_shufflevector(along, along, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
    sum += w * along;
  }
  const auto of = [&](int k) { return (sum[k] + sum[k + 4]) + (sum[k + 8] + sum[k + 12]); };
  return {of(0), of(1), of(2)};
}

}  // namespace slosh
