// A guided task, followed by the host's thread and told to whoever asks.
#pragma once

#include <mutex>

#include "host/guided_task.h"
#include "host/tap.h"

namespace slosh {

class TaskTap final : public HostTap {
 public:
  /// The scene, which has a task, must outlive it.
  TaskTap(const Scene& scene, const SampledScene& sampled) : scene_(scene), task_(scene, sampled) {}

  void on_start(const World& world, const HostState&) override { follow(world); }
  void after_step(const World& world) override { follow(world); }
  void after_change(const World& world, const HostCommand&, const HostState&) override { follow(world); }

  /// Any thread.
  TaskLines lines() const;
  /// The steps that are done, in their order.
  std::vector<TaskState::Done> done() const;

 private:
  void follow(const World& world) {
    if (!task_.follow(world)) return;
    const std::lock_guard lock(mutex_);
    state_ = task_.state();
  }

  const Scene& scene_;
  GuidedTask task_;  // the host's thread alone
  mutable std::mutex mutex_;
  TaskState state_;
};

}  // namespace slosh
