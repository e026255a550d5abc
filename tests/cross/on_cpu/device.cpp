#include "device.h"

#include <setjmp.h>
#include <ucontext.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace on_cpu {

Index thread_index{}, block_index{}, block_size{1, 1, 1}, grid_size{1, 1, 1};
double shuffled[1024], exchanged[2 * 1024];

namespace {

enum class State { kRuns, kAtWarp, kAtBlock, kAtGrid, kDone };

struct Fiber {
  static constexpr std::size_t kStack = 65536;
  ucontext_t first;  // where it begins
  jmp_buf place;     // and where it is, once it has begun
  bool begun;
  State state;
  unsigned members;  // of the warp, that it waits for
  unsigned turn;     // how many exchanges it has come to
  std::unique_ptr<char[]> stack;
  Index thread, block;
};

std::vector<Fiber> fibers;
Fiber* running = nullptr;
ucontext_t outside;
jmp_buf scheduler;
const std::function<void()>* kernel = nullptr;

[[noreturn]] void give_up(const char* why) {
  std::fprintf(stderr, "a kernel on the CPU: %s\n", why);
  std::abort();
}

void begin() {
  (*kernel)();
  running->state = State::kDone;
  _longjmp(scheduler, 1);
}

// From one stack to another and back, tens of millions of times. swapcontext() asks the kernel for the signal
// mask each time: with it the quick comparisons took 410 s for 21.
void go_on(Fiber& fiber) {
  if (_setjmp(scheduler)) return;
  if (fiber.begun) _longjmp(fiber.place, 1);
  fiber.begun = true;
  swapcontext(&outside, &fiber.first);
}

void wait(State at) {
  if (!running) give_up("a barrier in a kernel that launches.py took for one without");
  Fiber* self = running;
  self->state = at;
  if (!_setjmp(self->place)) _longjmp(scheduler, 1);
}

void prepare(Fiber& fiber, unsigned block, unsigned thread) {
  if (!fiber.stack) fiber.stack.reset(new char[Fiber::kStack]);
  getcontext(&fiber.first);
  fiber.first.uc_stack.ss_sp = fiber.stack.get();
  fiber.first.uc_stack.ss_size = Fiber::kStack;
  fiber.first.uc_link = nullptr;
  fiber.begun = false;
  fiber.thread = {thread, 0, 0};
  fiber.block = {block, 0, 0};
  fiber.state = State::kRuns;
  fiber.turn = 0;
  makecontext(&fiber.first, begin, 0);
}

// Lets those of a warp go on that are all there. False where there are none.
bool release_warp(Fiber* warp, unsigned threads) {
  bool any = false;
  for (unsigned t = 0; t < threads; ++t) {
    if (warp[t].state != State::kAtWarp) continue;
    const unsigned members = warp[t].members;
    bool all = (members >> t & 1u) != 0;
    for (unsigned other = 0; other < 32; ++other) {
      if (members >> other & 1u)
        all = all && other < threads && warp[other].state == State::kAtWarp && warp[other].members == members;
    }
    if (!all) continue;
    for (unsigned other = 0; other < 32; ++other) {
      if (members >> other & 1u) warp[other].state = State::kRuns;
    }
    any = true;
  }
  return any;
}

// Until all of its threads wait for the grid, or all are done.
void run_block(Fiber* block, unsigned threads) {
  while (true) {
    unsigned at_block = 0, at_grid = 0, done = 0;
    for (unsigned t = 0; t < threads; ++t) {
      if (block[t].state == State::kRuns) {
        running = &block[t];
        thread_index = running->thread;
        block_index = running->block;
        go_on(*running);
      }
      at_block += block[t].state == State::kAtBlock;
      at_grid += block[t].state == State::kAtGrid;
      done += block[t].state == State::kDone;
    }
    if (at_grid == threads || done == threads) return;
    bool released = false;
    for (unsigned t = 0; t < threads; t += 32)
      released |= release_warp(block + t, std::min(32u, threads - t));
    if (released) continue;
    if (at_block != threads) give_up("not all of a block's or a team's threads come to the same barrier");
    for (unsigned t = 0; t < threads; ++t) block[t].state = State::kRuns;
  }
}

void need_fibers(std::size_t count) {
  if (fibers.size() < count) fibers.resize(count);
}

void run_blocks(unsigned blocks, unsigned threads) {
  need_fibers(threads);
  // The last first: a GPU promises no order of blocks.
  for (unsigned b = blocks; b-- > 0;) {
    for (unsigned t = 0; t < threads; ++t) prepare(fibers[t], b, t);
    run_block(fibers.data(), threads);
    if (fibers.front().state != State::kDone) give_up("waits for the grid, unknown to launches.py");
  }
}

void run_all_blocks(unsigned blocks, unsigned threads) {
  const std::size_t count = std::size_t{blocks} * threads;
  need_fibers(count);
  for (std::size_t i = 0; i < count; ++i)
    prepare(fibers[i], static_cast<unsigned>(i / threads), static_cast<unsigned>(i % threads));
  while (true) {
    for (unsigned b = blocks; b-- > 0;) run_block(&fibers[std::size_t{b} * threads], threads);
    std::size_t done = 0;
    for (std::size_t i = 0; i < count; ++i) done += fibers[i].state == State::kDone;
    if (done == count) break;
    if (done > 0) give_up("not all blocks come to the same barrier of the grid");
    for (std::size_t i = 0; i < count; ++i) fibers[i].state = State::kRuns;
  }
}

}  // namespace

void block_barrier() {
  wait(State::kAtBlock);
}
void grid_barrier() {
  wait(State::kAtGrid);
}
void warp_barrier(unsigned members) {
  if (running) {
    running->members = members;
    ++running->turn;
  }
  wait(State::kAtWarp);
}
unsigned warp_turn() {
  return running ? running->turn : 0;
}

void run_grid(unsigned blocks, unsigned threads, Waits waits, const std::function<void()>& body) {
  grid_size = {blocks, 1, 1};
  block_size = {threads, 1, 1};
  if (waits != Waits::kForNobody) {
    kernel = &body;
    if (waits == Waits::kInBlock) {
      run_blocks(blocks, threads);
    } else {
      run_all_blocks(blocks, threads);
    }
    running = nullptr;
    return;
  }
  for (unsigned b = 0; b < blocks; ++b) {
    for (unsigned t = 0; t < threads; ++t) {
      block_index = {b, 0, 0};
      thread_index = {t, 0, 0};
      body();
    }
  }
}

}  // namespace on_cpu

// The calls of CUDA's runtime that sim/cuda makes, over plain memory: all is done when it is asked for.
extern "C" {

cudaError_t cudaMalloc(void** at, size_t bytes) {
  *at = nullptr;
  if (posix_memalign(at, 256, bytes) != 0) return cudaErrorMemoryAllocation;
  std::memset(*at, 0xa5, bytes);  // what nobody wrote is nobody's zero
  return cudaSuccess;
}
cudaError_t cudaFree(void* at) {
  std::free(at);
  return cudaSuccess;
}
cudaError_t cudaMallocHost(void** at, size_t bytes) {
  *at = std::malloc(bytes);
  return *at ? cudaSuccess : cudaErrorMemoryAllocation;
}
cudaError_t cudaHostAlloc(void** at, size_t bytes, unsigned) {
  return cudaMallocHost(at, bytes);
}
cudaError_t cudaFreeHost(void* at) {
  return cudaFree(at);
}
cudaError_t cudaMemset(void* at, int value, size_t bytes) {
  std::memset(at, value, bytes);
  return cudaSuccess;
}
cudaError_t cudaMemsetAsync(void* at, int value, size_t bytes, cudaStream_t) {
  return cudaMemset(at, value, bytes);
}
cudaError_t cudaMemcpy(void* to, const void* from, size_t bytes, cudaMemcpyKind) {
  std::memcpy(to, from, bytes);
  return cudaSuccess;
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, size_t bytes, cudaMemcpyKind kind, cudaStream_t) {
  return cudaMemcpy(to, from, bytes, kind);
}
cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned) {
  *stream = nullptr;
  return cudaSuccess;
}
cudaError_t cudaStreamDestroy(cudaStream_t) {
  return cudaSuccess;
}
cudaError_t cudaStreamSynchronize(cudaStream_t) {
  return cudaSuccess;
}
cudaError_t cudaDeviceSynchronize() {
  return cudaSuccess;
}
cudaError_t cudaEventCreate(cudaEvent_t* event) {
  *event = nullptr;
  return cudaSuccess;
}
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned) {
  return cudaEventCreate(event);
}
cudaError_t cudaEventDestroy(cudaEvent_t) {
  return cudaSuccess;
}
cudaError_t cudaEventRecord(cudaEvent_t, cudaStream_t) {
  return cudaSuccess;
}
cudaError_t cudaEventSynchronize(cudaEvent_t) {
  return cudaSuccess;
}
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t, cudaEvent_t) {
  *ms = 0.0f;
  return cudaSuccess;
}
cudaError_t cudaGetLastError() {
  return cudaSuccess;
}
const char* cudaGetErrorString(cudaError_t) {
  return "on the CPU";
}
cudaError_t cudaGetDeviceCount(int* count) {
  *count = 1;
  return cudaSuccess;
}
cudaError_t cudaSetDevice(int device) {
  return device == 0 ? cudaSuccess : cudaErrorInvalidDevice;
}
cudaError_t cudaGetDevice(int* device) {
  *device = 0;
  return cudaSuccess;
}
// No driver: its own calls are not to be had.
#if CUDART_VERSION >= 12050
cudaError_t cudaGetDriverEntryPointByVersion(const char*, void** call, unsigned, unsigned long long,
                                             cudaDriverEntryPointQueryResult*) {
#else
cudaError_t cudaGetDriverEntryPoint(const char*, void** call, unsigned long long) {
#endif
  *call = nullptr;
  return cudaErrorNotSupported;
}
#undef cudaGetDeviceProperties
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* device, int) {
  *device = cudaDeviceProp{};
  std::strcpy(device->name, "CUDA's kernels on one CPU thread");
  return cudaSuccess;
}
cudaError_t cudaGetDeviceProperties_v2(cudaDeviceProp* device, int) {
  return cudaGetDeviceProperties(device, 0);
}
// As many multiprocessors: a cooperative launch gets three blocks.
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr, int) {
  *value = 3;
  return cudaSuccess;
}
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, const void*, int, size_t) {
  *blocks = 1;
  return cudaSuccess;
}

}  // extern "C"
