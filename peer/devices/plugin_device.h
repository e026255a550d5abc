// A device behind a vendor's library: plugin:FILE[:OPTIONS].
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "peer/devices/admittance_motion.h"
#include "peer/devices/camera_view.h"
#include "peer/devices/hand_map.h"
#include "peer/devices/plugin_library.h"
#include "peer/devices/velocity_window.h"

namespace slosh {

/// What the plug-in does wrong stays its own: what it throws or blocks ends or silences this hand
/// (DevicePort); numbers that are not finite silence it; opening and closing are given kPatience. open()
/// reads once, so that a plug-in that never answers is known before a world waits for it. One that measures
/// force (SLOSH_DEVICE_ADMITTANCE) is moved by AdmittanceMotion: its hand is where it is told to be. A force
/// that is not known for kForceHolds, or that is no number, moves nothing: it is told to stand. One that
/// gives none (SLOSH_DEVICE_POSITION) is a hand as a gamepad's.
class PluginDevice final : public Device {
 public:
  PluginDevice(std::string file, std::string options, HandPlace place);
  ~PluginDevice() override;

  /// Errors: those of load_plugin; it refuses, throws, takes too long or has no sound capabilities or first
  /// reading; its file has a mistake.
  Result<bool> open() override;
  DeviceReport read(const DeviceMoment& moment) override;
  void write(const Wrench& on_hand) override;
  void rest() override;
  DeviceLimits limits() const override { return limits_; }
  void look_from(const glm::dquat& axes) override { camera_now_.publish(axes); }
  void close() override;
  bool gives_way() const override { return !only_tells_; }
  std::string kind() const override { return "plugin"; }
  std::string trouble() const override;
  std::string status() const override;
  std::vector<std::string> warnings() const override { return warnings_; }

  static constexpr double kPatience = 5.0;     ///< s for open
  static constexpr double kCloseWait = 1.0;    ///< s
  static constexpr double kForceHolds = 0.01;  ///< s
  static constexpr double kAskedAgain = 0.1;   ///< s between two sentences of it

 private:
  struct Handle;  // what a call that never returns goes on using
  Error failed(const std::string& what) const;
  Result<bool> settle(const slosh_device_capabilities& said);
  DeviceReport taken(const slosh_device_reading& reading);
  DeviceReport silent() const;
  Result<bool> settle_motion(const slosh_device_capabilities& said, DeviceFile& file, double own,
                             double own_turning);
  void sense(const slosh_device_reading& reading, const DeviceReport& measured);
  void move(const Wrench& wrench);
  /// Passes a call's throw and its refusal on, as an exception that names the plug-in.
  template <class Call>
  int asked(const char* function, Call&& call) const;
  void set_trouble(const std::string& words);
  void ask_words();

  const std::string file_;
  const std::string options_;
  const HandPlace place_;
  std::shared_ptr<Handle> handle_;
  CameraView camera_now_;
  std::optional<HandMap> map_;
  DeviceLimits limits_;
  std::vector<std::string> warnings_;
  VelocityWindow velocity_;
  std::optional<AdmittanceMotion> motion_;  // of a device that measures force
  bool moves_ = false;                      // and it is known where it is
  double period_ = 0.001;                   // s
  std::int64_t sensed_ns_ = 0;
  std::int64_t moved_ns_ = 0;
  std::optional<DeviceReport> first_;
  bool unsound_ = false;
  bool only_tells_ = false;  // a device without force
  std::int64_t asked_ns_ = 0;

  mutable std::mutex mutex_;
  std::string trouble_;
  std::string its_trouble_;  // in its own words
  std::string its_status_;
};

}  // namespace slosh
