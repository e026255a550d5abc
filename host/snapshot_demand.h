// Whether anybody looks at the world's snapshots: where the viewer's side says so and the host's loop reads
// it.
#pragma once

#include <atomic>
#include <cstdint>

namespace slosh {

/// Any thread; nobody waits. At first snapshots are wanted.
class SnapshotDemand {
 public:
  void want(bool wanted) {
    if (!wanted_.exchange(wanted, std::memory_order_relaxed) && wanted)
      asked_.store(true, std::memory_order_relaxed);
  }
  bool wanted() const { return wanted_.load(std::memory_order_relaxed); }

  /// The host's side: somebody began to look, and no snapshot was made since. True once.
  bool take_ask() { return asked_.exchange(false, std::memory_order_relaxed); }
  /// Before a snapshot of `run` (BodyMessage::run) is handed on.
  void note_made(std::uint32_t run) {
    asked_.store(false, std::memory_order_relaxed);
    run_.store(run, std::memory_order_release);
  }
  /// The run of the newest snapshot; the coder's may be behind.
  std::uint32_t run() const { return run_.load(std::memory_order_acquire); }

 private:
  std::atomic<bool> wanted_{true};
  std::atomic<bool> asked_{false};
  std::atomic<std::uint32_t> run_{0};
};

}  // namespace slosh
