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
/// What the batches are made of, for people.
inline constexpr const char* kInstructions =
#if defined(__AVX512F__)
    "AVX-512";
#elif defined(__AVX2__)
    "AVX2";
#elif defined(__x86_64__)
    "SSE";
#else
    "this processor's";
#endif

template <>
struct RealOps<FloatBatch> {
  static FloatBatch positive_part(FloatBatch x) { return xsimd::max(x, FloatBatch(0.0f)); }
  static FloatBatch where_less(FloatBatch a, FloatBatch b, FloatBatch yes, FloatBatch no) {
    return xsimd::select(a < b, yes, no);
  }
  static FloatBatch root(FloatBatch x) { return xsimd::sqrt(x); }
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

inline DragShape<FloatBatch> in_all_lanes(const DragShape<float>& shape) {
  return {FloatBatch(shape.level), FloatBatch(shape.growth)};
}

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

/// Which lanes of a batch: bit k is lane k's.
using PickedLanes = std::uint32_t;

/// Those in which a < b.
inline PickedLanes lanes_less(FloatBatch a, FloatBatch b) {
#if defined(__AVX512F__)
  return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
#elif defined(__AVX2__)
  return static_cast<PickedLanes>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
#else
  alignas(64) float of_a[kLanes], of_b[kLanes];
  a.store_aligned(of_a);
  b.store_aligned(of_b);
  PickedLanes picked = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) picked |= PickedLanes{of_a[lane] < of_b[lane]} << lane;
  return picked;
#endif
}
inline int count_of(PickedLanes picked) {
  return __builtin_popcount(picked);
}

#if defined(__AVX2__) && !defined(__AVX512F__)
/// For each set of lanes their numbers one after another.
inline constexpr auto kLanesOf = [] {
  std::array<std::array<std::int32_t, 8>, 256> table{};
  for (std::size_t picked = 0; picked < 256; ++picked) {
    std::size_t count = 0;
    for (int lane = 0; lane < 8; ++lane) {
      if (picked >> lane & 1) table[picked][count++] = lane;
    }
  }
  return table;
}();
#endif

/// Stores the picked lanes one after another; what lies behind them up to a whole batch is overwritten.
inline void store_picked(FloatBatch x, PickedLanes picked, float* to) {
#if defined(__AVX512F__)
  _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(picked), x));
#elif defined(__AVX2__)
  const __m256i lanes = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kLanesOf[picked].data()));
  _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(x, lanes));
#else
  alignas(64) float values[kLanes];
  x.store_aligned(values);
  for (; picked; picked &= picked - 1) *to++ = values[__builtin_ctz(picked)];
#endif
}

/// The same of first, first + 1, …
inline void store_picked_indices(std::uint32_t first, PickedLanes picked, std::int32_t* to) {
#if defined(__AVX512F__)
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  _mm512_storeu_si512(to, _mm512_add_epi32(_mm512_maskz_compress_epi32(static_cast<__mmask16>(picked), lanes),
                                           _mm512_set1_epi32(static_cast<int>(first))));
#elif defined(__AVX2__)
  const __m256i lanes = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kLanesOf[picked].data()));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                      _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(first))));
#else
  for (; picked; picked &= picked - 1)
    *to++ = static_cast<std::int32_t>(first + static_cast<std::uint32_t>(__builtin_ctz(picked)));
#endif
}

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
