// A running world's switches as they are, for a window in the same process.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "host/tap.h"

namespace slosh {

/// Told by the host's thread, read by another.
class SwitchTap final : public HostTap {
 public:
  void on_start(const World&, const HostState& state) override { set(state); }
  void after_change(const World&, const HostCommand&, const HostState& state) override { set(state); }

  HostState state() const {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  /// For answers to commands.
  void refuse(const std::string& why) {
    const std::lock_guard lock(mutex_);
    refusals_.push_back(why);
  }
  std::vector<std::string> take_refusals() {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> taken;
    taken.swap(refusals_);
    return taken;
  }

 private:
  void set(const HostState& state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
  }
  mutable std::mutex mutex_;
  HostState state_;
  std::vector<std::string> refusals_;
};

}  // namespace slosh
