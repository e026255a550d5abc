// One run of one world: host, channel and peer joined in one process.
#pragma once

#include <memory>

#include "host/host.h"
#include "host/keep/recording.h"
#include "net/channel.h"
#include "peer/haptics/device_loop.h"
#include "peer/haptics/make_device.h"
#include "peer/output/recorder.h"
#include "peer/verbs/live_run.h"
#include "peer/verbs/prepare.h"

namespace slosh {

/// Made, started and ended by one thread. `prepared` must outlive it.
class Session final : public LiveRun {
 public:
  /// `picture_rate` as in HostOptions. Errors: a device cannot be opened, a file cannot be written.
  static Result<std::unique_ptr<Session>> create(const Prepared& prepared, DeviceSet devices,
                                                 double picture_rate);
  ~Session() override;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void start() override;
  void request_stop() override { host_->request_stop(); }
  bool running() override { return host_->running(); }
  void stop() override;
  SnapshotQueue& pictures() override { return channel_->pictures(); }
  SnapshotPointer newest_picture() override { return channel_->pictures().pop_newest(); }
  HudFacts facts(double picture_rate) const override;
  Rates note_rates() override;
  RateLog& rates() override { return rates_; }
  void pause(bool paused) override {
    paused_ = paused;
    host_->pause(paused);
  }
  bool paused() const override { return paused_; }
  MouseTarget* mouse_target(std::size_t i) override { return mouse_targets_[i].get(); }
  /// In place where the run is recorded, so that the recording goes on.
  bool start_again() override;
  std::string trouble() const override { return recorder_->problem(); }
  void report(RunSummary& summary) const override;

  Host& host() { return *host_; }
  Channel& channel() { return *channel_; }

 private:
  explicit Session(const Prepared& prepared) : prepared_(prepared) {}

  const Prepared& prepared_;
  std::unique_ptr<Channel> channel_;
  std::unique_ptr<keep::RecordingWriter> recording_;  // null where none was asked for; the host tells it
  std::unique_ptr<Host> host_;
  std::unique_ptr<Servo> servo_;
  std::unique_ptr<DeviceLoop> loop_;
  std::unique_ptr<Recorder> recorder_;
  RateLog rates_;
  std::vector<std::shared_ptr<MouseTarget>> mouse_targets_;  // one a grip, null where it is not a mouse
  bool paused_ = false;
  keep::RecordingReport recorded_;
};

}  // namespace slosh
