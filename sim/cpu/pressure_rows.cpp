#include "sim/cpu/pressure_rows.h"

#include <algorithm>
#include <cstring>

#include "sim/cpu/four_vectors.h"

namespace slosh {

namespace {

Four load(const Vector4& v) {
  return four_at(&v.x);
}

constexpr SixteenBits kOfVectors = {-1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0};

// What the neighbours have, four at a time, and the pairs' vectors with 0 for a fourth.
template <class Pair, class F>
void for_each_four(const Pair* pairs, std::size_t count, const Vector4* of_others, F&& f) {
  for (const Pair* four = pairs; four < pairs + count; four += 4) {
    SixteenBits bits;
    std::memcpy(&bits, four, sizeof bits);
    f(reinterpret_cast<Sixteen>(bits & kOfVectors),
      side_by_side(load(of_others[four[0].other]), load(of_others[four[1].other]),
                   load(of_others[four[2].other]), load(of_others[four[3].other])));
  }
}

}  // namespace

void PressureRows::clear(std::size_t count, std::size_t chunks) {
  rows_.assign(count, Row{});
  if (chunks_.size() < chunks) chunks_.resize(chunks);
  for (Chunk& chunk : chunks_) chunk.size = 0;
}

PressureRows::Writer::Writer(PressureRows& rows, std::size_t chunk)
    : rows_(rows), chunk_(static_cast<std::uint32_t>(chunk)) {
  make_room();
}

void PressureRows::Writer::make_room() {
  const std::size_t room = std::max<std::size_t>(256, 2 * other_.size());
  other_.resize(room);
  for (std::vector<float>* column : {&x_, &y_, &z_}) column->resize(room);
}

Vector4 PressureRows::Writer::end(const PressTensor* tensors) {
  Chunk& chunk = rows_.chunks_[chunk_];
  const std::size_t whole = (count_ + kTogether - 1) / kTogether * kTogether;
  if (chunk.size + whole > chunk.own.size()) {
    const std::size_t room = std::max<std::size_t>({4096, 2 * chunk.own.size(), chunk.size + whole});
    chunk.own.resize(room);
    chunk.other.resize(room);
  }
  Pair* const own = chunk.own.data() + chunk.size;
  Pair* const other = chunk.other.data() + chunk.size;
  const auto times = [](const PressTensor& t, float x, float y, float z) {
    return x * four_at(t.x) + y * four_at(t.y) + z * four_at(t.z);
  };
  const PressTensor self = tensors[p_];
  Four sum = {}, squares = {};
  for (std::size_t k = 0; k < count_; ++k) {
    const PressTensor& of_other = tensors[other_[k]];
    const Four by_own = times(self, x_[k], y_[k], z_[k]), by_other = times(of_other, x_[k], y_[k], z_[k]);
    sum += by_own;
    squares += of_other.x[3] * (by_own * by_own);
    std::memcpy(own + k, &by_own, sizeof by_own);
    std::memcpy(other + k, &by_other, sizeof by_other);
    own[k].other = other[k].other = other_[k];
  }
  for (std::size_t k = count_; k < whole; ++k) own[k] = other[k] = {0.0f, 0.0f, 0.0f, 0};
  rows_.rows_[p_] = {chunk_, static_cast<std::uint32_t>(chunk.size),
                     static_cast<std::uint32_t>(chunk.size + whole)};
  chunk.size += whole;
  return {sum[0], sum[1], sum[2], squares[0] + squares[1] + squares[2]};
}

Vector3<float> PressureRows::push_on(std::uint32_t p, const Vector4* pressures) const {
  const Row& row = rows_[p];
  Sixteen sum = {};
  for_each_four(chunks_[row.chunk].other.data() + row.begin, row.end - row.begin, pressures,
                [&](Sixteen w, Sixteen pressure) { sum += w * pressure; });
  const auto of = [&](int k) { return (sum[k] + sum[k + 4]) + (sum[k + 8] + sum[k + 12]); };
  return {of(0), of(1), of(2)};
}

float PressureRows::flow_by(std::uint32_t p, const Vector4* velocities) const {
  const Row& row = rows_[p];
  Sixteen sum = {};
  for_each_four(chunks_[row.chunk].own.data() + row.begin, row.end - row.begin, velocities,
                [&](Sixteen w, Sixteen velocity) { sum += w * velocity; });
  const auto of = [&](int k) { return (sum[k] + sum[k + 4]) + (sum[k + 8] + sum[k + 12]); };
  return of(0) + of(1) + of(2);
}

}  // namespace slosh
