// The CPU's batch of neighbours: the widest float vector of the machine this was compiled for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>
#include <xsimd/xsimd.hpp>

#include "sim/math/kernels.h"

namespace slosh {

using FloatBatch = xsimd::batch<float>;
inline constexpr std::size_t kLanes = FloatBatch::size;

template <>
struct RealOps<FloatBatch> {
  static FloatBatch positive_part(FloatBatch x) { return xsimd::max(x, FloatBatch(0.0f)); }
  // The hardware's estimate has 12 to 14 bits; one Newton step brings it to within a few last places.
  static FloatBatch inverse_sqrt(FloatBatch x) {
#ifdef __AVX512F__
    // xsimd 8.1 (Debian 12) names an intrinsic that does not exist here.
    const FloatBatch guess(_mm512_rsqrt14_ps(x));
#else
    const FloatBatch guess = xsimd::rsqrt(x);
#endif
    return guess * (FloatBatch(1.5f) - FloatBatch(0.5f) * x * guess * guess);
  }
};

/// The sum of all lanes. xsimd called it hadd (8.1, Debian 12) and calls it reduce_add (13, Debian 13).
template <class Batch>
float lane_sum(const Batch& x) {
  if constexpr (requires { reduce_add(x); }) {
    return reduce_add(x);
  } else {
    return hadd(x);
  }
}

/// 1 in the lanes before `count`, 0 in the others: for the last, partly filled batch of a row.
inline FloatBatch first_lanes(std::size_t count) {
  alignas(64) static constexpr auto kTable = [] {
    std::array<float, 2 * 64> table{};
    for (std::size_t i = 0; i < 64; ++i) table[i] = 1.0f;
    return table;
  }();
  return FloatBatch::load_unaligned(kTable.data() + 64 - count);
}

/// Which lanes of a batch are above 0, for store_picked().
#ifdef __AVX512F__
using PickedLanes = __mmask16;
inline PickedLanes lanes_above_zero(FloatBatch x) {
  return _mm512_cmp_ps_mask(x, _mm512_setzero_ps(), _CMP_GT_OQ);
}
inline int count_of(PickedLanes picked) { return __builtin_popcount(picked); }
/// Stores the picked lanes one after another; what lies behind them up to a whole batch is overwritten.
inline void store_picked(FloatBatch x, PickedLanes picked, float* to) {
  _mm512_storeu_ps(to, _mm512_maskz_compress_ps(picked, x));
}
/// The same of first, first + 1, …
inline void store_picked_indices(std::uint32_t first, PickedLanes picked, std::int32_t* to) {
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  _mm512_storeu_si512(to, _mm512_add_epi32(_mm512_maskz_compress_epi32(picked, lanes),
                                           _mm512_set1_epi32(static_cast<int>(first))));
}
#else
struct PickedLanes {
  std::array<std::uint8_t, kLanes + 1> lanes;  // one more than there can be, for the last that is not picked
  int count = 0;
};
inline PickedLanes lanes_above_zero(FloatBatch x) {
  alignas(64) float values[kLanes];
  x.store_aligned(values);
  PickedLanes picked;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    picked.lanes[static_cast<std::size_t>(picked.count)] = static_cast<std::uint8_t>(lane);
    picked.count += values[lane] > 0.0f;
  }
  return picked;
}
inline int count_of(const PickedLanes& picked) { return picked.count; }
inline void store_picked(FloatBatch x, const PickedLanes& picked, float* to) {
  alignas(64) float values[kLanes];
  x.store_aligned(values);
  for (int k = 0; k < picked.count; ++k) to[k] = values[picked.lanes[static_cast<std::size_t>(k)]];
}
inline void store_picked_indices(std::uint32_t first, const PickedLanes& picked, std::int32_t* to) {
  for (int k = 0; k < picked.count; ++k)
    to[k] = static_cast<std::int32_t>(first + picked.lanes[static_cast<std::size_t>(k)]);
}
#endif

/// Memory on cache lines, so that a batch does not straddle two at the start of an array.
template <class T>
struct LineAllocator {
  using value_type = T;
  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
  template <class U>
  bool operator==(const LineAllocator<U>&) const {
    return true;
  }
};

/// A column of particle data. Allocate kLanes more than there are particles: batches read past a row's end.
template <class T>
using Column = std::vector<T, LineAllocator<T>>;

}  // namespace slosh
