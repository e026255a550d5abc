// What a GPU does at best: a triad over its memory, fused multiply-adds in its registers.
#include <cuda_runtime.h>

#include <algorithm>
#include <string>

#include "tests/lab/report/ceilings.h"

namespace slosh::report {
namespace {

constexpr unsigned kThreads = 256;
constexpr unsigned kArray = 1u << 24;  // float4 each: 268 MB, more than any cache holds
constexpr int kChains = 8;
constexpr int kRounds = 4096;
constexpr unsigned kComputeBlocks = 8192;
constexpr int kRepeats = 8;

__global__ void triad(float4* a, const float4* b, const float4* c) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  const float4 x = b[i], y = c[i];
  a[i] = make_float4(x.x + 0.5f * y.x, x.y + 0.5f * y.y, x.z + 0.5f * y.z, x.w + 0.5f * y.w);
}

__global__ void multiply_and_add(float* out) {
  float chain[kChains];
  for (int k = 0; k < kChains; ++k) chain[k] = static_cast<float>(threadIdx.x + k);
  for (int i = 0; i < kRounds; ++i) {
#pragma unroll
    for (int k = 0; k < kChains; ++k) chain[k] = fmaf(chain[k], 0.999f, 0.001f);
  }
  float sum = 0.0f;
  for (int k = 0; k < kChains; ++k) sum += chain[k];
  out[blockIdx.x * blockDim.x + threadIdx.x] = sum;  // or the compiler would leave all of it out
}

/// s, the best of several; the first only warms up.
template <class Launch>
double best_of(Launch&& launch) {
  cudaEvent_t begin, end;
  cudaEventCreate(&begin);
  cudaEventCreate(&end);
  float best = 1e9f;
  for (int i = 0; i <= kRepeats; ++i) {
    cudaEventRecord(begin);
    launch();
    cudaEventRecord(end);
    cudaEventSynchronize(end);
    float ms = 1e9f;
    cudaEventElapsedTime(&ms, begin, end);
    if (i > 0) best = std::min(best, ms);
  }
  cudaEventDestroy(begin);
  cudaEventDestroy(end);
  return 1e-3 * static_cast<double>(best);
}

}  // namespace

Result<Ceilings> cuda_ceilings() {
  float4* arrays = nullptr;
  const std::size_t bytes = std::size_t{kArray} * sizeof(float4);
  cudaError_t code = cudaMalloc(&arrays, 3 * bytes);
  if (code == cudaSuccess) code = cudaMemset(arrays, 0, 3 * bytes);
  Ceilings found;
  if (code == cudaSuccess) {
    found.bytes_per_s =
        3.0 * static_cast<double>(bytes) / best_of([&] {
          triad<<<kArray / kThreads, kThreads>>>(arrays, arrays + kArray, arrays + 2 * std::size_t{kArray});
        });
    found.flops_per_s = 2.0 * kChains * kRounds * kComputeBlocks * kThreads / best_of([&] {
                          multiply_and_add<<<kComputeBlocks, kThreads>>>(reinterpret_cast<float*>(arrays));
                        });
    code = cudaGetLastError();
  }
  cudaFree(arrays);
  if (code != cudaSuccess)
    return Error{"the GPU's ceilings", cudaGetErrorString(code), "Measure on the CPU: --backend cpu"};
  return found;
}

}  // namespace slosh::report
