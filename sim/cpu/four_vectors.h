// Vectors of four floats, four of them side by side: what rows of pairs are walked with.
#pragma once

#include <cstdint>
#include <cstring>

#include "sim/cpu/simd.h"

namespace slosh {

using Four = float __attribute__((vector_size(16)));
using Eight = float __attribute__((vector_size(32)));
using EightBits = std::int32_t __attribute__((vector_size(32)));

#ifdef __AVX512F__
using Part = float __attribute__((vector_size(64)));
using PartBits = std::int32_t __attribute__((vector_size(64)));
#else
using Part = Eight;
using PartBits = EightBits;
#endif
/// As the widest vectors of the machine this was compiled for: a wider one GCC takes apart float by float.
struct Sixteen {
  static constexpr std::size_t kParts = 64 / sizeof(Part);
  Part part[kParts];

  template <class F>
  static Sixteen each(F&& f) {
    Sixteen out;
    for (std::size_t k = 0; k < kParts; ++k) out.part[k] = f(k);
    return out;
  }
  Sixteen& operator+=(const Sixteen& o) { return *this = *this + o; }
  Sixteen& operator-=(const Sixteen& o) { return *this = *this - o; }
  friend Sixteen operator+(const Sixteen& a, const Sixteen& b) {
    return each([&](std::size_t k) { return a.part[k] + b.part[k]; });
  }
  friend Sixteen operator-(const Sixteen& a, const Sixteen& b) {
    return each([&](std::size_t k) { return a.part[k] - b.part[k]; });
  }
  friend Sixteen operator*(const Sixteen& a, const Sixteen& b) {
    return each([&](std::size_t k) { return a.part[k] * b.part[k]; });
  }
  friend Sixteen operator*(float a, const Sixteen& b) {
    return each([&](std::size_t k) { return a * b.part[k]; });
  }
  friend Sixteen operator+(const Sixteen& a, float b) {
    return each([&](std::size_t k) { return a.part[k] + b; });
  }
  friend Sixteen operator-(float a, const Sixteen& b) {
    return each([&](std::size_t k) { return a - b.part[k]; });
  }
};

/// Of four floats that lie one after the other.
inline Four four_at(const float* v) {
  Four out;
  std::memcpy(&out, v, sizeof out);
  return out;
}

/// Of four floats each.
inline Sixteen side_by_side(const float* a, const float* b, const float* c, const float* d) {
#ifdef __AVX512F__
  // In GCC's own words this takes two more instructions.
  const auto eights = [](const float* low, const float* high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low)), _mm_loadu_ps(high), 1);
  };
  return {
      {reinterpret_cast<Part>(_mm512_insertf32x8(_mm512_castps256_ps512(eights(a, b)), eights(c, d), 1))}};
#else
  const auto two = [](const float* low, const float* high) {
    return __builtin_shufflevector(four_at(low), four_at(high), 0, 1, 2, 3, 4, 5, 6, 7);
  };
  return {{two(a, b), two(c, d)}};
#endif
}

/// Of eight floats the first, third, fifth and seventh, four times each.
inline Sixteen each_even_four_times(const float* v) {
  Eight eight;
  std::memcpy(&eight, v, sizeof eight);
#ifdef __AVX512F__
  return {{__builtin_shufflevector(eight, eight, 0, 0, 0, 0, 2, 2, 2, 2, 4, 4, 4, 4, 6, 6, 6, 6)}};
#else
  return {{__builtin_shufflevector(eight, eight, 0, 0, 0, 0, 2, 2, 2, 2),
           __builtin_shufflevector(eight, eight, 4, 4, 4, 4, 6, 6, 6, 6)}};
#endif
}

/// 1/√ of each, which must be above 0: an estimate and one Newton step, as RealOps<FloatBatch> has it.
inline Sixteen inverse_roots(const Sixteen& v) {
  return Sixteen::each([&](std::size_t k) {
    const Part x = v.part[k];
#if defined(__AVX512F__)
    const Part guess = reinterpret_cast<Part>(_mm512_rsqrt14_ps(reinterpret_cast<__m512>(x)));
#elif defined(__AVX__)
    const Part guess = reinterpret_cast<Part>(_mm256_rsqrt_ps(reinterpret_cast<__m256>(x)));
#else
    Part guess;
    for (int i = 0; i < 8; ++i) guess[i] = RealOps<float>::inverse_sqrt(x[i]);
#endif
    return guess * (1.5f - 0.5f * x * guess * guess);
  });
}

/// v, or 0 where that is below.
inline Sixteen at_least_zero(const Sixteen& v) {
  return Sixteen::each([&](std::size_t k) { return v.part[k] > 0.0f ? v.part[k] : Part{}; });
}

/// `v` where `test` is above 0, else 0.
inline Sixteen where_above_zero(const Sixteen& test, const Sixteen& v) {
  return Sixteen::each([&](std::size_t k) { return test.part[k] > 0.0f ? v.part[k] : Part{}; });
}

/// Four pairs of 8 bytes: each four's first and the whole number that is beside it in the pair.
inline void put_pairs(const Sixteen& firsts, const std::int32_t* numbers, void* to) {
  using FourBits = std::int32_t __attribute__((vector_size(16)));
  FourBits four;
  std::memcpy(&four, numbers, sizeof four);
  const Eight beside = reinterpret_cast<Eight>(__builtin_shufflevector(four, four, 0, 0, 1, 1, 2, 2, 3, 3));
#ifdef __AVX512F__
  const Eight even = __builtin_shufflevector(firsts.part[0], firsts.part[0], 0, 0, 4, 4, 8, 8, 12, 12);
#else
  const Eight even = __builtin_shufflevector(firsts.part[0], firsts.part[1], 0, 0, 4, 4, 8, 8, 12, 12);
#endif
  const Eight pairs = __builtin_shufflevector(even, beside, 0, 9, 2, 11, 4, 13, 6, 15);
  std::memcpy(to, &pairs, sizeof pairs);
}

/// The floats of each eight in the order of the template's arguments.
template <int... order>
Sixteen ordered(const Sixteen& v) {
  return Sixteen::each([&](std::size_t k) {
#ifdef __AVX512F__
    return __builtin_shufflevector(v.part[k], v.part[k], order..., (8 + order)...);
#else
    return __builtin_shufflevector(v.part[k], v.part[k], order...);
#endif
  });
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
