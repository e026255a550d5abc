// One run of one world: host, channel and peer joined in one process.
#pragma once

#include <memory>

#include "host/host.h"
#include "host/keep/recording.h"
#include "net/channel.h"
#include "peer/app/export_source.h"
#include "peer/app/hands_tap.h"
#include "peer/app/live_run.h"
#include "peer/app/lockstep.h"
#include "peer/app/measure_tap.h"
#include "peer/app/prepare.h"
#include "peer/app/pressure_tap.h"
#include "peer/app/switch_tap.h"
#include "peer/app/wrench_tap.h"
#include "peer/haptics/device_loop.h"
#include "peer/haptics/make_device.h"
#include "peer/output/recorder.h"
#include "peer/remote/remote_status.h"

namespace slosh {

/// Made, started and ended by one thread. `prepared` must outlive it.
class LocalRun final : public LiveRun {
 public:
  /// `snapshot_rate` as in HostOptions. `progress` is told where it is going to take long (agree_on_time);
  /// null where that was told already. Errors: a device cannot be opened, a file cannot be written, it takes
  /// too long.
  static Result<std::unique_ptr<LocalRun>> create(const Prepared& prepared, DeviceSet devices,
                                                  double snapshot_rate, Progress* progress);
  ~LocalRun() override;
  LocalRun(const LocalRun&) = delete;
  LocalRun& operator=(const LocalRun&) = delete;

  void start() override;
  void request_stop() override {
    if (lockstep_) lockstep_->request_stop();
    host_->request_stop();
  }
  bool running() override { return host_->running(); }
  void stop() override;
  SnapshotQueue& snapshots() override { return channel_->snapshots(); }
  SnapshotPointer newest_snapshot() override { return channel_->snapshots().pop_newest(); }
  HudFacts facts(double picture_rate) const override;
  Rates note_rates() override;
  RateLog& rates() override { return rates_; }
  void pause(bool paused) override {
    paused_ = paused;
    host_->pause(paused);
  }
  bool paused() const override { return paused_; }
  MouseTarget* mouse_target(std::size_t i) override { return mouse_targets_[i].get(); }
  SharedHandle* lent_hand(std::size_t i) override { return lent_[i].get(); }
  LiveValues live_values() const override;
  void change(const LiveWish& wish) override;
  void step_standing(int steps) override { host_->step_standing(steps); }
  std::vector<std::string> take_notices() override { return switches_.take_notices(); }
  bool hears() const override { return true; }
  std::string hear(const std::string& line) override;
  void look_from(const glm::dquat& axes) override { servo_->look_from(axes); }
  /// In place, so that the files of the run, its film and its recording go on.
  bool start_again() override;
  std::shared_ptr<const std::vector<float>> pressures(bool wanted) override {
    return pressure_tap_.look(wanted);
  }
  std::string trouble() const override;
  std::size_t exports_waiting() const override { return exporter_ ? exporter_->waiting() : 0; }
  void report(RunSummary& summary) const override;

  Host& host() { return *host_; }
  Channel& channel() { return *channel_; }

 private:
  explicit LocalRun(const Prepared& prepared) : prepared_(prepared) {}
  void carry_out(const RemoteCommand& command);

  const Prepared& prepared_;
  std::unique_ptr<Channel> channel_;
  std::unique_ptr<keep::RecordingWriter> recording_;  // null where none was asked for; the host tells it
  std::unique_ptr<WrenchTap> wrenches_;
  SwitchTap switches_;
  std::unique_ptr<HandsTap> hands_;
  std::unique_ptr<Measurer> measurer_;  // null where nothing is measured, as its tap
  std::unique_ptr<MeasureTap> measure_tap_;
  std::unique_ptr<Exporter> exporter_;  // null where nothing is exported, as its tap
  std::unique_ptr<ExportTap> export_tap_;
  PressureTap pressure_tap_;
  std::unique_ptr<Lockstep> lockstep_;  // null where the run is paced
  FluidDemand fluid_demand_;            // of hands that feel
  std::unique_ptr<Host> host_;
  std::unique_ptr<Servo> servo_;
  std::unique_ptr<DeviceLoop> loop_;
  std::unique_ptr<Recorder> recorder_;
  RateLog rates_;
  std::vector<std::shared_ptr<MouseTarget>> mouse_targets_;  // one a grip, null where it is not a mouse
  std::vector<std::shared_ptr<SharedHandle>> lent_;          // one a grip, null where it is not lent
  bool paused_ = false;
  keep::RecordingReport recorded_;
};

}  // namespace slosh
