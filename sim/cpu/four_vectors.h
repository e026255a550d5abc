// Vectors of four floats, four of them side by side: what rows of pairs are walked with. The compiler makes of it what
// the machine has.
#pragma once

#include <cstdint>
#include <cstring>

#include "sim/cpu/simd.h"

namespace slosh {

using Four = float __attribute__((vector_size(16)));
using Eight = float __attribute__((vector_size(32)));
using Sixteen = float __attribute__((vector_size(64)));
using SixteenBits = std::int32_t __attribute__((vector_size(64)));

inline Sixteen side_by_side(Four a, Four b, Four c, Four d) {
#ifdef __AVX512F__
  // Left to itself GCC 12 takes twice as many instructions.
  const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(a), b, 1);
  const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(c), d, 1);
  return _mm512_castpd_ps(
      _mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(low)), _mm256_castps_pd(high), 1));
#else
  const Eight low = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
  const Eight high = __builtin_shufflevector(c, d, 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}

/// Of four floats that lie one after the other.
inline Four four_at(const float* v) {
  Four out;
  std::memcpy(&out, v, sizeof out);
  return out;
}

/// Of eight floats the first, third, fifth and seventh, four times each.
inline Sixteen each_even_four_times(const float* v) {
  Eight eight;
  std::memcpy(&eight, v, sizeof eight);
  return __builtin_shufflevector(eight, eight, 0, 0, 0, 0, 2, 2, 2, 2, 4, 4, 4, 4, 6, 6, 6, 6);
}

/// 1/√ of each, which must be above 0.
inline Sixteen inverse_roots(Sixteen v) {
  alignas(64) float of[16];
  std::memcpy(of, &v, sizeof v);
  for (std::size_t k = 0; k < 16; k += kLanes)
    RealOps<FloatBatch>::inverse_sqrt(FloatBatch::load_aligned(of + k)).store_aligned(of + k);
  std::memcpy(&v, of, sizeof v);
  return v;
}

/// In each four the second, the third, the first; the fourth stays.
inline Sixteen turned(Sixteen v) {
  return __builtin_shufflevector(v, v, 1, 2, 0, 3, 5, 6, 4, 7, 9, 10, 8, 11, 13, 14, 12, 15);
}
/// And back.
inline Sixteen turned_back(Sixteen v) {
  return __builtin_shufflevector(v, v, 2, 0, 1, 3, 6, 4, 5, 7, 10, 8, 9, 11, 14, 12, 13, 15);
}
/// In each four its fourth.
inline Sixteen fourths(Sixteen v) {
  return __builtin_shufflevector(v, v, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
}
/// In each four the sum of the four.
inline Sixteen sums(Sixteen v) {
  v += __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
  return v + __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
}

}  // namespace slosh
