// A headset's hand controller as a device: a pose in, vibration out.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "net/clock.h"
#include "peer/devices/device_file.h"
#include "peer/devices/hand_map.h"
#include "peer/devices/headset_link.h"
#include "peer/devices/velocity_window.h"
#include "peer/haptics/device.h"

namespace slosh {

struct ControllerSettings {
  enum class HoldWith : std::uint8_t { kSqueeze, kTrigger, kAlways } hold_with = HoldWith::kSqueeze;
  bool open_hand_lets_go = false;  ///< else what it held stays where it was
  double vibration = 1.0;          ///< factor on the strength, 0–1; 0 = none
  double full_vibration = 6.0;     ///< N by which the force has to change at once for the strongest, > 0
};
/// Errors: mistakes in the file, with file and line.
Result<ControllerSettings> read_controller_settings(DeviceFile file);

/// How strong a vibration a force is worth that changes: what is beyond its own mean of the last 0.05 s. One
/// thread; no allocation.
class ForceChange {
 public:
  /// 0–1. `full` in N; torques count as at an arm of 0.1 m.
  double strength(const Wrench& on_hand, double seconds, double full) noexcept;

  static constexpr double kMeanOver = 0.05;  ///< s
  static constexpr double kUnfelt = 0.1;     ///< of `full`: below it the hand stays quiet

 private:
  Wrench mean_;
  bool begun_ = false;
};

/// While the grip button is held the hand moves as the controller does; open, it stays where it was, so that
/// a long way is gone in several moves. Not tracked (behind the back, no headset, another program's menu) it
/// is open. Its calls wait for no picture; they run on the device's own thread.
class ControllerDevice final : public Device {
 public:
  /// `now_ns`: steady_now_ns, or a test's.
  ControllerDevice(std::shared_ptr<HeadsetLink> link, HandSide side, const Pose& start,
                   std::function<std::int64_t()> now_ns = steady_now_ns);

  /// Errors: mistakes in its file, xr.conf.
  Result<bool> open() override;
  DeviceReport read(const DeviceMoment& moment) override;
  void write(const Wrench& on_hand) override;
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool gives_way() const override { return false; }
  void close() override;
  std::string kind() const override { return side_ == HandSide::kLeft ? "xr-left" : "xr-right"; }
  std::string trouble() const override;
  std::string status() const override;

 private:
  bool held(const HandReading& reading) const;

  std::shared_ptr<HeadsetLink> link_;
  const HandSide side_;
  std::function<std::int64_t()> now_ns_;
  ControllerSettings settings_;
  HandMap map_;
  VelocityWindow velocity_;
  Pose last_;            // in the world, where the controller was last seen
  bool closed_ = false;  // the hand
  ForceChange change_;
  std::int64_t wrote_ns_ = 0;
  std::int64_t shaken_ns_ = 0;
  double strongest_ = 0.0;  // since it was last shaken

  mutable std::mutex mutex_;
  bool tracked_ = false;
  bool ever_tracked_ = false;
  HandReading shown_;
};

}  // namespace slosh
