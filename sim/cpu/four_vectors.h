// Vectors of four floats, four of them side by side: what rows of pairs are walked with. The compiler makes of it what
// the machine has.
#pragma once

#include <cstdint>
#include <cstring>

namespace slosh {

using Four = float __attribute__((vector_size(16)));
using Eight = float __attribute__((vector_size(32)));
using Sixteen = float __attribute__((vector_size(64)));
using SixteenBits = std::int32_t __attribute__((vector_size(64)));

inline Sixteen side_by_side(Four a, Four b, Four c, Four d) {
  const Eight low = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
  const Eight high = __builtin_shufflevector(c, d, 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

/// Of four floats that lie one after the other.
inline Four four_at(const float* v) {
  Four out;
  std::memcpy(&out, v, sizeof out);
  return out;
}

}  // namespace slosh
