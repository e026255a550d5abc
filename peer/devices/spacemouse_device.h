// A 3Dconnexion SpaceMouse as a hand: six axes in, no force.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "net/clock.h"
#include "peer/devices/camera_view.h"
#include "peer/devices/hid_port.h"
#include "peer/devices/spacemouse_models.h"
#include "peer/devices/spacemouse_motion.h"
#include "peer/haptics/device.h"

namespace slosh {

/// One that is plugged in.
struct SpaceMouseFound {
  HidInfo hid;
  const SpaceMouseModel* model = nullptr;
};
/// All of them, claimed by this process or not.
std::vector<SpaceMouseFound> find_spacemice();

/// What it said lately, for people.
struct SpaceMouseLive {
  std::string name;
  bool there = false;
  SpaceMouseState state;
  std::uint64_t reports = 0;    ///< that were understood
  std::uint64_t malformed = 0;  ///< too short, or out of range: passed over
};

/// Unplugged, it says nothing (DeviceReport::heard) and looks for itself, twice a second, until it is back:
/// the same serial number, else the same model. A deflection that is not said again for kSilence ends: the
/// battery of a wireless one that dies must not let the hand run on.
class SpaceMouseDevice final : public Device {
 public:
  /// `which`: a serial number, a path ("/dev/hidraw3"), or empty for the first that no other hand has.
  /// `camera` as SpaceMouseMotion has it.
  /// `now_ns`: steady_now_ns, or a test's.
  SpaceMouseDevice(std::string which, const Pose& start, const glm::dquat& camera,
                   std::function<std::int64_t()> now_ns = steady_now_ns);
  ~SpaceMouseDevice() override;

  /// Errors: none is there, it may not be opened, its file has a mistake.
  Result<bool> open() override;
  DeviceReport read(const DeviceMoment& moment) override;
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool gives_way() const override { return false; }
  void look_from(const glm::dquat& axes) override { camera_now_.publish(axes); }
  void close() override;
  std::string kind() const override { return "spacemouse"; }
  std::string trouble() const override;
  std::string status() const override;

  SpaceMouseLive live() const;  ///< any thread

  static constexpr double kSilence = 0.25;   ///< s
  static constexpr double kLookAgain = 0.5;  ///< s between two looks for one that is gone

 private:
  Result<bool> open_first();
  Result<bool> open_path(const SpaceMouseFound& found);
  void look_again(std::int64_t now_ns);
  /// False when the device is gone.
  bool take_reports(std::int64_t now_ns);
  void light(bool on);
  void show();

  const std::string which_;
  const Pose start_;
  const glm::dquat camera_;
  std::function<std::int64_t()> now_ns_;
  CameraView camera_now_;
  std::optional<HidPort> port_;
  std::optional<SpaceMouseMotion> motion_;
  std::string serial_;
  std::uint16_t product_ = 0;
  SpaceMouseLive now_;
  std::int64_t advanced_ns_ = 0;
  std::int64_t received_ns_ = 0;
  std::int64_t looked_ns_ = 0;

  mutable std::mutex mutex_;
  SpaceMouseLive shown_;
};

}  // namespace slosh
