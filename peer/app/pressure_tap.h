// The particles' pressures for a window that shows them: read off the world a few times a second, only while
// they are looked at.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "host/tap.h"
#include "sim/world.h"

namespace slosh {

/// Pa, one a particle in the order of Snapshot::positions; NaN where there is none.
using Pressures = std::shared_ptr<const std::vector<float>>;

class PressureTap final : public HostTap {
 public:
  /// Any thread: whether they are wanted from now on. The newest, null before there are any.
  Pressures look(bool wanted) {
    wanted_.store(wanted, std::memory_order_relaxed);
    const std::lock_guard lock(mutex_);
    if (!wanted) newest_.reset();
    return newest_;
  }

  void after_step(const World& world) override {
    if (wanted_.load(std::memory_order_relaxed) &&
        (world.time() >= next_ || world.time() < next_ - 2.0 * kEvery))
      read(world);
  }
  void while_standing(const World& world) override {
    if (wanted_.load(std::memory_order_relaxed) && look(true) == nullptr) read(world);
  }

 private:
  static constexpr double kEvery = 1.0 / 30.0;  // s, simulated

  void read(const World& world) {
    next_ = world.time() + kEvery;
    auto pressures = std::make_shared<std::vector<float>>();
    world.fill_pressures(*pressures);
    const std::lock_guard lock(mutex_);
    newest_ = std::move(pressures);
  }

  std::atomic<bool> wanted_{false};
  std::mutex mutex_;
  Pressures newest_;
  double next_ = 0.0;  // s, the host's thread alone
};

}  // namespace slosh
