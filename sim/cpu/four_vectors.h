// Vectors of four floats, four of them side by side: what rows of pairs are walked with.
#pragma once

#include <cstdint>
#include <cstring>

#include "sim/cpu/simd.h"

namespace slosh {

using Four = float __attribute__((vector_size(16)));
using Eight = float __attribute__((vector_size(32)));
using EightBits = std::int32_t __attribute__((vector_size(32)));

/// Two eights, as the widest vectors of many machines are: one vector of sixteen GCC takes apart float by
/// float there.
struct Sixteen {
  Eight low, high;

  Sixteen& operator+=(const Sixteen& o) { return *this = {low + o.low, high + o.high}; }
  Sixteen& operator-=(const Sixteen& o) { return *this = {low - o.low, high - o.high}; }
  friend Sixteen operator+(const Sixteen& a, const Sixteen& b) { return {a.low + b.low, a.high + b.high}; }
  friend Sixteen operator-(const Sixteen& a, const Sixteen& b) { return {a.low - b.low, a.high - b.high}; }
  friend Sixteen operator*(const Sixteen& a, const Sixteen& b) { return {a.low * b.low, a.high * b.high}; }
  friend Sixteen operator*(float a, const Sixteen& b) { return {a * b.low, a * b.high}; }
  friend Sixteen operator+(const Sixteen& a, float b) { return {a.low + b, a.high + b}; }
  friend Sixteen operator-(float a, const Sixteen& b) { return {a - b.low, a - b.high}; }
};

inline Sixteen side_by_side(Four a, Four b, Four c, Four d) {
  return {__builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7),
          __builtin_shufflevector(c, d, 0, 1, 2, 3, 4, 5, 6, 7)};
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
  return {__builtin_shufflevector(eight, eight, 0, 0, 0, 0, 2, 2, 2, 2),
          __builtin_shufflevector(eight, eight, 4, 4, 4, 4, 6, 6, 6, 6)};
}

/// 1/√ of each, which must be above 0: an estimate and one Newton step, as RealOps<FloatBatch> has it.
inline Eight inverse_roots(Eight v) {
#ifdef __AVX512VL__
  const Eight guess = reinterpret_cast<Eight>(_mm256_rsqrt14_ps(reinterpret_cast<__m256>(v)));
#elif defined(__AVX__)
  const Eight guess = reinterpret_cast<Eight>(_mm256_rsqrt_ps(reinterpret_cast<__m256>(v)));
#else
  Eight guess;
  for (int k = 0; k < 8; ++k) guess[k] = RealOps<float>::inverse_sqrt(v[k]);
#endif
  return guess * (1.5f - 0.5f * v * guess * guess);
}
inline Sixteen inverse_roots(const Sixteen& v) {
  return {inverse_roots(v.low), inverse_roots(v.high)};
}

/// v, or 0 where that is below.
inline Sixteen at_least_zero(const Sixteen& v) {
  return {v.low > 0.0f ? v.low : Eight{}, v.high > 0.0f ? v.high : Eight{}};
}

/// `v` where `test` is above 0, else 0.
inline Sixteen where_above_zero(const Sixteen& test, const Sixteen& v) {
  const auto half = [](Eight t, Eight x) {
    return reinterpret_cast<Eight>(reinterpret_cast<EightBits>(x) & (t > 0.0f));
  };
  return {half(test.low, v.low), half(test.high, v.high)};
}

/// Four pairs of 8 bytes: each four's first and the whole number that is beside it in the pair.
inline void put_pairs(const Sixteen& firsts, const std::int32_t* numbers, void* to) {
  using FourBits = std::int32_t __attribute__((vector_size(16)));
  FourBits four;
  std::memcpy(&four, numbers, sizeof four);
  const Eight beside = reinterpret_cast<Eight>(__builtin_shufflevector(four, four, 0, 0, 1, 1, 2, 2, 3, 3));
  const Eight even = __builtin_shufflevector(firsts.low, firsts.high, 0, 0, 4, 4, 8, 8, 12, 12);
  const Eight pairs = __builtin_shufflevector(even, beside, 0, 9, 2, 11, 4, 13, 6, 15);
  std::memcpy(to, &pairs, sizeof pairs);
}

/// Each half's floats in the order of the template's arguments.
template <int... order>
Sixteen ordered(const Sixteen& v) {
  return {__builtin_shufflevector(v.low, v.low, order...), __builtin_shufflevector(v.high, v.high, order...)};
}
/// In each four the second, the third, the first; the fourth stays.
inline Sixteen turned(const Sixteen& v) {
  return ordered<1, 2, 0, 3, 5, 6, 4, 7>(v);
}
/// And back.
inline Sixteen turned_back(const Sixteen& v) {
  return ordered<2, 0, 1, 3, 6, 4, 5, 7>(v);
}
/// In each four its fourth.
inline Sixteen fourths(const Sixteen& v) {
  return ordered<3, 3, 3, 3, 7, 7, 7, 7>(v);
}
/// In each four the sum of the four.
inline Sixteen sums(const Sixteen& v) {
  const Sixteen pairs = v + ordered<1, 0, 3, 2, 5, 4, 7, 6>(v);
  return pairs + ordered<2, 3, 0, 1, 6, 7, 4, 5>(pairs);
}

}  // namespace slosh
