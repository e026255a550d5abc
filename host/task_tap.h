// A guided task, followed by the host's thread and told to whoever asks.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "host/guided_task.h"
#include "host/tap.h"
#include "sim/math/result.h"

namespace slosh {

class TaskTap final : public HostTap {
 public:
  /// Asks the host to do what a finished step brings (Host::post).
  using Ask = std::function<void(const HostCommand&, std::function<void(const Result<bool>&)>)>;

  /// The scene, which has a task, must outlive it.
  TaskTap(const Scene& scene, const SampledScene& sampled, Ask ask)
      : scene_(scene), task_(scene, sampled), ask_(std::move(ask)) {}

  void on_start(const World& world, const HostState&) override { follow(world); }
  void after_step(const World& world) override { follow(world); }
  void after_change(const World& world, const HostCommand&, const HostState&) override { follow(world); }
  void on_end(const World& world) override { spilled_ = task_.spilled(world); }

  /// Before the run, of a world that carries on: GuidedTask::carry_on. What these steps brought is in the
  /// world.
  void carry_on(const std::vector<double>& took);
  /// Any thread.
  TaskLines lines() const;
  std::vector<double> took() const;  ///< s, of the steps that are done
  /// The steps that are done, in their order.
  std::vector<TaskState::Done> done() const;
  double spilled() const { return spilled_; }  ///< kg, as GuidedTask::spilled at the end of the run; after it

 private:
  void follow(const World& world);
  void answered(std::uint32_t begun, const Result<bool>& answer);

  const Scene& scene_;
  GuidedTask task_;  // the host's thread alone, as all of these
  Ask ask_;
  double spilled_ = 0.0;
  std::size_t steps_acted_ = 0;  // whose acts are in `open_`, or done
  std::vector<TaskAct> open_;    // still to be done, in order
  bool asked_ = false;           // for the first of them, and no answer yet
  double ask_again_ = 0.0;       // simulated s
  std::uint32_t begun_ = 0;      // of this many tasks begun the answers count
  mutable std::mutex mutex_;
  TaskState state_;
  std::vector<HandMove> hands_;
  std::string refused_;  // why the first of `open_` has to wait
};

}  // namespace slosh
