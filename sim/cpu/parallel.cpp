#include "sim/cpu/parallel.h"

#include <sched.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace slosh {

namespace {
// Cores that this process may run on: taskset and containers count, which hardware_concurrency leaves out.
int cores_there() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return std::max(1, CPU_COUNT(&allowed));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// $SLOSH_THREADS, where it is a number above 0, is the most that a world takes unless it was told a number.
// Many worlds side by side, each on all of many cores, wait for each other more than they compute: tests are
// such.
int cores_allowed() {
  const int there = cores_there();
  const char* most = std::getenv("SLOSH_THREADS");
  int number = 0;
  if (!most || std::from_chars(most, most + std::strlen(most), number).ec != std::errc() || number < 1)
    return there;
  return std::min(there, number);
}

// About 20 µs: passes of one step follow each other faster than a sleeping thread wakes up.
constexpr int kSpins = 2000;
constexpr std::uint32_t kOpen = 1u << 31;

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

// Returns once `value` differs from `old`, spinning first and sleeping after.
std::uint32_t wait_for_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  for (int spin = 0; spin < kSpins; ++spin) {
    const std::uint32_t now = value.load(std::memory_order_acquire);
    if (now != old) return now;
    relax();
  }
  value.wait(old, std::memory_order_acquire);
  return value.load(std::memory_order_acquire);
}
}  // namespace

ThreadTeam::ThreadTeam(int threads) {
  if (threads <= 0) threads = cores_allowed();
  parts_ = std::vector<Part>(static_cast<std::size_t>(threads));
  for (std::size_t i = 1; i < parts_.size(); ++i) workers_.emplace_back([this, i] { worker_loop(i); });
}

ThreadTeam::~ThreadTeam() {
  stopping_.store(true, std::memory_order_relaxed);
  generation_.fetch_add(1, std::memory_order_release);
  generation_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadTeam::run(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  // The same chunks for one thread as for many: rows of pairs lie by fours within a chunk (pair_rows.h), and
  // by who is beside whom a sum that carries its rounding along may end a bit elsewhere.
  if (workers_.empty() || count <= chunk) {
    for (std::size_t begin = 0; begin < count; begin += chunk) body(begin, std::min(begin + chunk, count));
    return;
  }
  body_ = &body;
  count_ = count;
  chunk_ = chunk;
  const std::size_t chunks = chunk_count(count, chunk), threads = parts_.size();
  for (std::size_t i = 0; i < threads; ++i) {
    parts_[i].next.store(chunks * i / threads, std::memory_order_relaxed);
    parts_[i].end = chunks * (i + 1) / threads;
  }
  gate_.store(kOpen, std::memory_order_release);
  generation_.fetch_add(1, std::memory_order_release);
  generation_.notify_all();
  work_on_chunks(0);
  std::uint32_t inside = gate_.fetch_and(~kOpen, std::memory_order_acq_rel) & ~kOpen;
  while (inside != 0) inside = wait_for_change(gate_, inside);
}

bool ThreadTeam::join() {
  std::uint32_t seen = gate_.load(std::memory_order_relaxed);
  while (seen & kOpen) {
    if (gate_.compare_exchange_weak(seen, seen + 1, std::memory_order_acq_rel)) return true;
  }
  return false;
}

void ThreadTeam::leave() {
  if (gate_.fetch_sub(1, std::memory_order_acq_rel) == 1) gate_.notify_one();
}

void ThreadTeam::work_on_chunks(std::size_t thread) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[(thread + i) % parts_.size()];
    for (;;) {
      const std::size_t at = part.next.fetch_add(1, std::memory_order_relaxed);
      if (at >= part.end) break;
      const std::size_t begin = at * chunk_;
      (*body_)(begin, std::min(begin + chunk_, count_));
    }
  }
}

void ThreadTeam::worker_loop(std::size_t thread) {
  std::uint32_t seen = 0;
  for (;;) {
    seen = wait_for_change(generation_, seen);
    if (stopping_.load(std::memory_order_relaxed)) return;
    if (!join()) continue;
    work_on_chunks(thread);
    leave();
  }
}

}  // namespace slosh
