// What the kernels of sim/cuda need to be compiled as C++ and run by one CPU thread: each of a grid's threads
// after the other, as fibers where a kernel's threads wait for each other. Included before everything else.
// Shows wrong sums, wrong indices and barriers that not all reach; not races, not what a GPU's own arithmetic
// rounds.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
// The library's own use of what is a word of CUDA's from here on.
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#undef __launch_bounds__
#define __launch_bounds__(...)
#undef __grid_constant__
#define __grid_constant__
#undef __noinline__
#define __noinline__ __attribute__((noinline))
// One block's at a time: none lives on over a barrier of the grid, where blocks take turns.
#define __shared__ static

namespace on_cpu {

struct Index {
  unsigned x, y, z;
};
extern Index thread_index, block_index, block_size, grid_size;

void block_barrier();
void grid_barrier();
/// Of the threads of a warp that `members` has a bit of.
void warp_barrier(unsigned members);

/// For whom a kernel's threads wait, and so what runs as fibers.
enum class Waits { kForNobody, kInBlock, kInGrid };

/// Runs `body` once a thread. Aborts where some of those who should come to a barrier do not.
void run_grid(unsigned blocks, unsigned threads, Waits waits, const std::function<void()>& body);

/// What kernel<<<blocks, threads>>>(arguments) becomes (launches.py).
struct Launch {
  unsigned blocks, threads;
  Waits waits;
  template <class Kernel, class... Arguments>
  void run(Kernel&& kernel, Arguments&&... arguments) {
    run_grid(blocks, threads, waits, [&] { kernel(arguments...); });
  }
};

extern double shuffled[1024], exchanged[2 * 1024];
/// How many of these the thread has come to.
unsigned warp_turn();

/// Of the thread `by` further on in the warp, back if below 0; `value` where there is none.
template <class T>
T shuffle(T value, int by) {
  const int thread = static_cast<int>(thread_index.x), from = thread % 32 + by;
  shuffled[thread] = value;
  block_barrier();
  const T other = from >= 0 && from < 32 ? static_cast<T>(shuffled[thread + by]) : value;
  block_barrier();
  return other;
}

template <class T>
T shuffle_xor(unsigned members, T value, int by) {
  const unsigned thread = thread_index.x;
  // Nobody is more than one exchange ahead of its team, so two places in turn are enough.
  const unsigned turn = warp_turn() % 2 * 1024;
  exchanged[turn + thread] = value;
  warp_barrier(members);
  return static_cast<T>(exchanged[turn + (thread ^ static_cast<unsigned>(by))]);
}

}  // namespace on_cpu

#define threadIdx on_cpu::thread_index
#define blockIdx on_cpu::block_index
#define blockDim on_cpu::block_size
#define gridDim on_cpu::grid_size
#define __syncthreads on_cpu::block_barrier
#define __shfl_down_sync(mask, value, by) on_cpu::shuffle(value, by)
#define __shfl_up_sync(mask, value, by) on_cpu::shuffle(value, -(by))
#define __shfl_xor_sync(mask, value, by) on_cpu::shuffle_xor(mask, value, by)

template <class T>
T __ldg(const T* at) {
  return *at;
}
template <class T>
T __ldcg(const T* at) {
  return *at;
}
// A thread runs until it waits, so that it is alone.
inline unsigned __activemask() {
  return 1u << on_cpu::thread_index.x % 32;
}
template <class T>
unsigned __match_any_sync(unsigned threads, T) {
  return threads;
}
inline int __ffs(int bits) {
  return __builtin_ffs(bits);
}
inline int __popc(unsigned bits) {
  return __builtin_popcount(bits);
}
inline void __threadfence() {}
template <class T>
T __ldcs(const T* at) {
  return *at;
}
inline float __uint_as_float(unsigned bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
inline unsigned __float_as_uint(float value) {
  unsigned bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}
inline int __clz(int bits) {
  return bits == 0 ? 32 : __builtin_clz(static_cast<unsigned>(bits));
}
inline unsigned __funnelshift_l(unsigned low, unsigned high, unsigned by) {
  return by % 32 == 0 ? high : high << by % 32 | low >> (32 - by % 32);
}
inline int __dp4a(int a, int b, int sum) {
  for (int byte = 0; byte < 4; ++byte)
    sum += static_cast<std::int8_t>(a >> 8 * byte) * static_cast<std::int8_t>(b >> 8 * byte);
  return sum;
}
template <class T, class U>
T atomicAdd(T* at, U more) {
  const T before = *at;
  *at += more;
  return before;
}
template <class T, class U>
T atomicOr(T* at, U bits) {
  const T before = *at;
  *at |= bits;
  return before;
}
using std::isfinite;
using std::max;
using std::min;
