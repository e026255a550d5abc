// A fixed team of threads for the passes of a step.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace slosh {

/// How many chunks of at most `chunk` ThreadTeam::run parts `count` into.
constexpr std::size_t chunk_count(std::size_t count, std::size_t chunk) {
  return (count + chunk - 1) / chunk;
}

/// Runs a body over [0, count) in chunks on all its threads, the caller's included. Each takes the same part
/// of the chunks every time, so that what it wrote in the pass before is in its own cache, then what others
/// have left; a body must write only its own indices, so that the result does not depend on who ran
/// what.
class ThreadTeam {
 public:
  /// threads: in all, the caller's among them; 0 = all cores.
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }

  /// body(begin, end) for chunks of at most `chunk` indices. Returns when all are done.
  void run(std::size_t count, std::size_t chunk, const std::function<void(std::size_t, std::size_t)>& body);

 private:
  bool join();
  void leave();
  void work_on_chunks(std::size_t thread);
  void worker_loop(std::size_t thread);

  // Chunks of one thread's part, the next of them first.
  struct alignas(64) Part {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
  };

  std::vector<std::thread> workers_;
  std::vector<Part> parts_;  // one a thread, the caller's first
  const std::function<void(std::size_t, std::size_t)>* body_ = nullptr;
  std::size_t count_ = 0;
  std::size_t chunk_ = 1;
  std::atomic<std::uint32_t> generation_{0};
  // Open for joining (the top bit), and how many workers are in. A worker that the system has put aside when
  // the work is over never joins, and nobody waits for it.
  std::atomic<std::uint32_t> gate_{0};
  std::atomic<bool> stopping_{false};
};

}  // namespace slosh
