// One run of one world: host, channel and peer joined in one process.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/host.h"
#include "host/task_tap.h"
#include "net/channel.h"
#include "peer/app/hands_tap.h"
#include "peer/app/live_run.h"
#include "peer/app/lockstep.h"
#include "peer/app/prepare.h"
#include "peer/app/window_tap.h"
#include "peer/app/world_files.h"

namespace slosh {

/// Made, started and ended by one thread. `prepared` must outlive it.
class LocalRun final : public LiveRun {
 public:
  /// `snapshot_rate` as in HostOptions. `progress` is told where it is going to take long (settle_world).
  /// Errors: a device cannot be opened, a file cannot be written, it takes too long.
  static Result<std::unique_ptr<LiveRun>> create(const Prepared& prepared, DeviceSet devices,
                                                 double snapshot_rate, Progress& progress);
  ~LocalRun() override { stop(); }

  void start() override;
  void request_stop() override;
  bool running() override { return host_->running(); }
  void stop() override;
  SnapshotQueue& snapshots() override { return channel_->snapshots(); }
  HudFacts facts(double picture_rate) const override;
  bool paused() const override { return paused_; }
  LiveValues live_values() const override;
  void change(const LiveWish& wish) override;
  void step_standing(int steps) override { host_->step_standing(steps); }
  std::vector<std::string> take_notices() override { return window_tap_.take_notices(); }
  bool hears() const override { return true; }
  std::shared_ptr<const std::vector<float>> pressures(bool wanted) override {
    return window_tap_.pressures(wanted);
  }
  std::string trouble() const override { return hands_->trouble(files_->problem()); }
  std::size_t exports_waiting() const override { return files_->frames_waiting(); }
  void report(RunSummary& summary) const override;

 private:
  explicit LocalRun(const Prepared& prepared)
      : prepared_(prepared), hands_tap_(prepared.scene.grips.size()) {}
  OwnHands* hands() const override { return hands_.get(); }
  Rates world_rates() override;
  PeerLine understand(const std::string& line) override;
  void ask(const RemoteCommand& command, bool typed) override;
  void follow_task(const std::vector<HandMove>& moves);
  void hand_over();

  const Prepared& prepared_;
  std::unique_ptr<Channel> channel_;
  HandsTap hands_tap_;
  WindowTap window_tap_;
  std::unique_ptr<TaskTap> task_tap_;  // null where the scene has no task
  std::unique_ptr<WorldFiles> files_;
  std::unique_ptr<Lockstep> lockstep_;  // null where the run is paced
  FluidDemand fluid_demand_;            // of hands that feel
  std::unique_ptr<Host> host_;
  std::unique_ptr<OwnHands> hands_;
  bool paused_ = false;
  // Hands that a task gives another tool.
  struct Handover {
    std::uint32_t from = 0, to = 0;
    std::string spec;
    std::int64_t since_ns = 0;
  };
  std::vector<std::string> specs_;  // one a grip; empty = no device of ours
  std::function<Result<HandDevice>(std::size_t, const std::string&, const Pose&)> another_device_;
  std::size_t hands_moved_ = 0;  // of the task's
  std::vector<Handover> on_their_way_;
};

}  // namespace slosh
