// Sums over a block and over all of them, in one fixed shape, and the bodies' six-vectors: what the solves of
// one launch share.
#pragma once

#include "sim/cuda/solve_rows.h"
#include "sim/math/dense.h"
#include "sim/math/pose.h"

namespace slosh::cuda {

inline constexpr int kWarps = kSolveThreads / 32;

/// The sums of each of a block's threads' values, in every thread.
template <int count>
__device__ inline void sum_block(double (&values)[count]) {
  __shared__ double shared[count][kWarps];
  for (double& value : values) {
    for (int half = 16; half > 0; half /= 2) value += __shfl_down_sync(0xffffffffu, value, half);
  }
  __syncthreads();  // who has still to read what the last call left
  if (threadIdx.x % 32 == 0) {
    for (int k = 0; k < count; ++k) shared[k][threadIdx.x / 32] = values[k];
  }
  __syncthreads();
  for (int k = 0; k < count; ++k) {
    values[k] = 0.0;
    for (int w = 0; w < kWarps; ++w) values[k] += shared[k][w];
  }
}

__device__ inline double part_of(const double* parts, std::uint32_t count) {
  double sum = 0.0;
  for (std::uint32_t i = threadIdx.x; i < count; i += kSolveThreads) sum += parts[i];
  return sum;
}

__device__ inline double dot(const Vector6& a, const Vector6& b) {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}
__device__ inline Vector6 times(const Matrix6& m, const Vector6& v) {
  Vector6 out{};
  for (int i = 0; i < 6; ++i) out[i] = dot(m[i], v);
  return out;
}
__device__ inline Vector6 vector_of(const Twist& t) {
  return {t.linear.x, t.linear.y, t.linear.z, t.angular.x, t.angular.y, t.angular.z};
}

}  // namespace slosh::cuda
