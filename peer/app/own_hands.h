// The hands of the person here: their devices, the loop that serves them, the files of what they did and
// felt.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "peer/app/prepare.h"
#include "peer/haptics/device_loop.h"
#include "peer/haptics/make_device.h"
#include "peer/output/recorder.h"
#include "peer/output/summary.h"
#include "peer/view/hud/rates.h"
#include "peer/view/live_panel.h"

namespace slosh {

/// Made, started and ended by one thread, which is also the one that calls everything here.
class OwnHands {
 public:
  /// `devices`: open, one a grip; or none at all, then set() brings them. Of `servo` coupling and steps
  /// count, the rest is `stage`'s. `folder` as in Recorder::start. `stage` and `channel` must outlive it.
  /// Errors: a file cannot be written.
  static Result<std::unique_ptr<OwnHands>> create(const Stage& stage, DeviceSet devices, Channel& channel,
                                                  ServoOptions servo, const std::filesystem::path& folder);
  ~OwnHands() { stop(); }
  OwnHands(const OwnHands&) = delete;
  OwnHands& operator=(const OwnHands&) = delete;

  /// Their poses have been posted when it returns.
  void start() { loop_.start(); }
  /// Every device was sent zero and is closed, and the files are whole, when it returns. May be called again.
  void stop();

  /// From the next tick on `hand`, open, holds grip `i`; an empty one takes away what is there.
  void set(std::size_t i, HandDevice hand);
  Servo& servo() { return servo_; }
  /// Where the mouse moves the handle of grip `i`; null when that hand is no mouse.
  MouseTarget* mouse_target(std::size_t i) const { return mice_[i].get(); }
  /// The hand of grip `i` where a script holds it that the window may take over; else null.
  SharedHandle* lent(std::size_t i) const { return lent_[i].get(); }

  /// `stiffness`: the world's, times the scene's, one a grip or none.
  void follow_stiffness(const std::vector<double>& stiffness);
  /// The same for sliders, with what the devices make of it.
  std::vector<LiveGrip> live_grips(const std::vector<double>& stiffness) const;

  /// Fills what is known of devices.
  void note(Rates& rates) const;
  /// What has gone wrong with the hands' files, else `others`, and with devices; empty while nothing has.
  std::string trouble(const std::string& others) const;
  /// Fills what is known of devices and their files; after stop().
  void report(RunSummary& summary) const;

 private:
  OwnHands(const Stage& stage, DeviceSet devices, Channel& channel, const ServoOptions& servo);

  const Stage& stage_;
  std::vector<std::shared_ptr<MouseTarget>> mice_;   // one a grip, null where it is not a mouse
  std::vector<std::shared_ptr<SharedHandle>> lent_;  // one a grip, null where it is not lent
  Servo servo_;
  DeviceLoop loop_;
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace slosh
