// Datagrams that wait for the link, by priority; the oldest go first when a queue is full.
#pragma once

#include <cstddef>
#include <deque>

#include "net/quic/endpoint.h"

namespace slosh::quic {

class DatagramQueues {
 public:
  explicit DatagramQueues(const std::size_t (&limits)[kPriorities]) {
    for (int i = 0; i < kPriorities; ++i) limits_[i] = limits[i];
  }

  /// How many old ones made room: 0 or 1. A queue of no places takes nothing and counts the new one.
  std::size_t push(int priority, SharedBytes bytes) {
    auto& queue = queues_[priority];
    if (limits_[priority] == 0) return 1;
    std::size_t dropped = 0;
    if (queue.size() >= limits_[priority]) {
      queue.pop_front();
      dropped = 1;
    }
    queue.push_back(std::move(bytes));
    return dropped;
  }

  /// The most urgent priority that has something, or -1.
  int next() const {
    for (int i = 0; i < kPriorities; ++i)
      if (!queues_[i].empty()) return i;
    return -1;
  }
  const SharedBytes& front(int priority) const { return queues_[priority].front(); }
  void pop(int priority) { queues_[priority].pop_front(); }
  bool empty() const { return next() < 0; }
  void clear() {
    for (auto& queue : queues_) queue.clear();
  }

  /// Size of the one after next(), 0 when there is none.
  std::size_t size_after_next() const {
    bool seen = false;
    for (const auto& queue : queues_) {
      if (queue.empty()) continue;
      if (seen) return queue.front()->size();
      if (queue.size() > 1) return queue[1]->size();
      seen = true;
    }
    return 0;
  }

 private:
  std::deque<SharedBytes> queues_[kPriorities];
  std::size_t limits_[kPriorities];
};

}  // namespace slosh::quic
