// For whose hands the fluid's wrench is modelled: where the network's side says so and the host's loop reads
// it.
#pragma once

#include <atomic>
#include <cstdint>

namespace slosh {

/// Any thread; nobody waits. At first nobody asks.
class FluidDemand {
 public:
  static constexpr std::uint32_t kMaxGrips = 64;  ///< wire::kMaxGrips

  /// Bit g: models of the body that grip g is on are wanted while it is held.
  void want(std::uint64_t grips) { grips_.store(grips, std::memory_order_relaxed); }
  std::uint64_t wanted() const { return grips_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> grips_{0};
};

}  // namespace slosh
