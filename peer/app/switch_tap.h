// A running world's switches as they are, for a window in the same process.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "host/gone_bodies.h"
#include "host/tap.h"

namespace slosh {

/// Told by the host's thread, read by another.
class SwitchTap final : public HostTap {
 public:
  void on_start(const World&, const HostState& state) override { set(state); }
  void after_change(const World&, const HostCommand&, const HostState& state) override { set(state); }

  void on_gone_body(std::size_t, const std::string& words) override { tell(words + kGoneAdvice); }

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
    std::vector<std::string> taken;
    taken.swap(notices_);
    return taken;
  }

 private:
  void set(const HostState& state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
  }
  mutable std::mutex mutex_;
  HostState state_;
  std::vector<std::string> notices_;
};

}  // namespace slosh
