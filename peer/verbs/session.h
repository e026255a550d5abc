// One run of one world: host, channel and peer joined in one process.
#pragma once

#include <memory>

#include "host/host.h"
#include "net/channel.h"
#include "peer/haptics/device_loop.h"
#include "peer/haptics/make_device.h"
#include "peer/hud/hud.h"
#include "peer/output/recorder.h"
#include "peer/output/summary.h"
#include "peer/verbs/prepare.h"

namespace slosh {

/// Made, started and ended by one thread. `prepared` must outlive it.
class Session {
 public:
  /// `picture_rate` as in HostOptions. Errors: a device cannot be opened, a file cannot be written.
  static Result<std::unique_ptr<Session>> create(const Prepared& prepared, DeviceSet devices,
                                                 double picture_rate);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void start();
  /// Ends the world, then the device loop, then the recording.
  void stop();

  Host& host() { return *host_; }
  Channel& channel() { return *channel_; }
  RateLog& rates() { return rates_; }
  HudFacts facts(double picture_rate) const;
  /// What is known right now; also written to the rate log.
  Rates note_rates();
  /// Fills what the session knows; after stop().
  void report(RunSummary& summary) const;

 private:
  explicit Session(const Prepared& prepared) : prepared_(prepared) {}

  const Prepared& prepared_;
  std::unique_ptr<Channel> channel_;
  std::unique_ptr<Host> host_;
  std::unique_ptr<Servo> servo_;
  std::unique_ptr<DeviceLoop> loop_;
  std::unique_ptr<Recorder> recorder_;
  RateLog rates_;
};

}  // namespace slosh
