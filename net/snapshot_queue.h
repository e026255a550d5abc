// Snapshots of the world on their way from the host to one viewer.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>

#include "sim/snapshot.h"

namespace slosh {

using SnapshotPointer = std::shared_ptr<const Snapshot>;

/// Bytes that a snapshot holds on to.
inline std::size_t size_in_bytes(const Snapshot& snapshot) {
  return sizeof(Snapshot) + (snapshot.positions.capacity() + snapshot.to_come) * sizeof(glm::vec3) +
         snapshot.fluid_index.capacity() + snapshot.to_come +
         snapshot.rigid.bodies.capacity() * sizeof(BodyState) +
         snapshot.rigid.grips.capacity() * sizeof(GripState);
}

/// First in, first out, bounded by bytes. Neither end is a device loop, so it may lock. A snapshot that does
/// not fit is dropped and counted: those already waiting are older and keep the film without a gap there. Who
/// takes one waits for what it has still to bring from a GPU.
class SnapshotQueue {
 public:
  explicit SnapshotQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// False when the snapshot was dropped. A snapshot always fits in an empty queue.
  bool push(std::shared_ptr<Snapshot> snapshot) {
    const std::size_t bytes = size_in_bytes(*snapshot);
    {
      const std::lock_guard lock(mutex_);
      if (!waiting_.empty() && bytes_ + bytes > max_bytes_) {
        dropped_ += 1;
        return false;
      }
      bytes_ += bytes;
      waiting_.push_back(std::move(snapshot));
    }
    changed_.notify_one();
    return true;
  }

  /// No more snapshots will come; a waiting pop() returns.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  /// The oldest snapshot; waits up to `patience`. Null when none came, or when closed and empty.
  SnapshotPointer pop(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [this] { return !waiting_.empty() || closed_; });
    if (waiting_.empty()) return nullptr;
    const std::shared_ptr<Snapshot> oldest = std::move(waiting_.front());
    waiting_.pop_front();
    bytes_ -= size_in_bytes(*oldest);
    lock.unlock();
    oldest->complete();
    return oldest;
  }

  /// The newest snapshot, the others thrown away (a window wants what is now); null when none waits.
  SnapshotPointer pop_newest() {
    std::shared_ptr<Snapshot> newest;
    {
      const std::lock_guard lock(mutex_);
      if (waiting_.empty()) return nullptr;
      newest = std::move(waiting_.back());
      waiting_.clear();
      bytes_ = 0;
    }
    newest->complete();
    return newest;
  }

  /// Closed, and every snapshot taken.
  bool finished() const {
    const std::lock_guard lock(mutex_);
    return closed_ && waiting_.empty();
  }
  std::size_t waiting() const {
    const std::lock_guard lock(mutex_);
    return waiting_.size();
  }
  std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  const std::size_t max_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<Snapshot>> waiting_;
  std::size_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace slosh
