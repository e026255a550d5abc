// Bounded queue between one producer and one consumer thread: no lock, no allocation after construction.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace slosh {

/// Holds at least `capacity` values. A full ring refuses the push and the producer counts the loss.
template <class T>
class Ring {
 public:
  explicit Ring(std::size_t capacity) : slots_(capacity + 1) {}

  bool push(const T& value) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t next = (tail + 1) % slots_.size();
    if (next == head_.load(std::memory_order_acquire)) return false;
    slots_[tail] = value;
    tail_.store(next, std::memory_order_release);
    return true;
  }

  bool pop(T& value) {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return false;
    value = slots_[head];
    head_.store((head + 1) % slots_.size(), std::memory_order_release);
    return true;
  }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace slosh
