// Newest-value exchange between one writer and one reader thread: no lock, no allocation, no waiting.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace slosh {

/// The writer fills back() and calls publish(); the reader calls update() and reads front(). Values that the
/// reader was too slow for are overwritten. T must be default constructible; its storage is reused, so
/// vectors inside stop allocating once they have grown (the writer's concern).
template <class T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  explicit TripleBuffer(const T& initial) { slots_.fill(initial); }

  T& back() { return slots_[back_]; }
  void publish() {
    back_ = shared_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }

  /// True when front() is newer than at the last call.
  bool update() {
    if (!(shared_.load(std::memory_order_relaxed) & kFresh)) return false;
    front_ = shared_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  const T& front() const { return slots_[front_]; }

 private:
  static constexpr std::uint8_t kFresh = 4;
  static constexpr std::uint8_t kIndex = 3;
  std::array<T, 3> slots_{};
  alignas(64) std::atomic<std::uint8_t> shared_{1};
  alignas(64) std::uint8_t back_ = 0;   // the writer's
  alignas(64) std::uint8_t front_ = 2;  // the reader's
};

}  // namespace slosh
