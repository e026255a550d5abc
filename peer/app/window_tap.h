// What a window and a terminal in the same process ask of a running world: its switches as they are, what
// there is to tell, and the particles' pressures, read off only while they are looked at.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "host/gone_bodies.h"
#include "host/tap.h"
#include "sim/world.h"

namespace slosh {

/// Pa, one a particle in the order of Snapshot::positions; NaN where there is none.
using Pressures = std::shared_ptr<const std::vector<float>>;

/// Told by the host's thread, asked by any.
class WindowTap final : public HostTap {
 public:
  HostState state() const {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  /// For answers to commands.
  void tell(const std::string& what) {
    const std::lock_guard lock(mutex_);
    notices_.push_back(what);
  }
  std::vector<std::string> take_notices() {
    const std::lock_guard lock(mutex_);
    return std::exchange(notices_, {});
  }
  /// Whether pressures are wanted from now on. The newest, null before there are any; a few a second.
  Pressures pressures(bool wanted) {
    wanted_.store(wanted, std::memory_order_relaxed);
    const std::lock_guard lock(mutex_);
    if (!wanted) pressures_.reset();
    return pressures_;
  }

  void on_start(const World&, const HostState& state) override { set(state); }
  void after_change(const World&, const HostCommand&, const HostState& state) override { set(state); }
  void on_gone_body(std::size_t, const std::string& words) override { tell(words + kGoneAdvice); }
  void after_step(const World& world) override {
    if (wanted_.load(std::memory_order_relaxed) &&
        (world.time() >= next_ || world.time() < next_ - 2.0 * kEvery))
      read(world);
  }
  void while_standing(const World& world) override {
    if (wanted_.load(std::memory_order_relaxed) && pressures(true) == nullptr) read(world);
  }

 private:
  static constexpr double kEvery = 1.0 / 30.0;  // s, simulated

  void set(const HostState& state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
  }
  void read(const World& world) {
    next_ = world.time() + kEvery;
    auto pressures = std::make_shared<std::vector<float>>();
    world.fill_pressures(*pressures);
    const std::lock_guard lock(mutex_);
    pressures_ = std::move(pressures);
  }

  std::atomic<bool> wanted_{false};
  double next_ = 0.0;  // s, the host's thread alone
  mutable std::mutex mutex_;
  HostState state_;
  std::vector<std::string> notices_;
  Pressures pressures_;
};

}  // namespace slosh
