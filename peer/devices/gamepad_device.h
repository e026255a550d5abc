// A gamepad as a hand: where its sticks are is where the hand is. No force.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "net/clock.h"
#include "peer/devices/camera_view.h"
#include "peer/devices/gamepad_port.h"
#include "peer/devices/spacemouse_motion.h"
#include "peer/haptics/device.h"

namespace slosh {

/// What a gamepad's file may leave out: a place by deflection, to 0.15 m and 0.8 rad; 30 counts of 350 that
/// worn sticks stray by; the left stick along the picture and into it, triggers up and down, the right stick
/// tilts towards the eye and to the sides, the shoulder buttons turn; the south button is the clutch.
SpaceMouseSettings gamepad_defaults();

/// Unplugged, it says nothing (DeviceReport::heard) and looks for itself, twice a second, until it is back:
/// the same name and serial number.
class GamepadDevice final : public Device {
 public:
  /// `which`: a serial number, a node ("/dev/input/event5"), a name, or empty for the first that no other
  /// hand has. `camera` as SpaceMouseMotion has it. `now_ns`: steady_now_ns, or a test's.
  GamepadDevice(std::string which, const Pose& start, const glm::dquat& camera,
                std::function<std::int64_t()> now_ns = steady_now_ns);
  ~GamepadDevice() override;

  /// Errors: none is there, it may not be opened, its file has a mistake.
  Result<bool> open() override;
  DeviceReport read(const DeviceMoment& moment) override;
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool gives_way() const override { return false; }
  void look_from(const glm::dquat& axes) override { camera_now_.publish(axes); }
  void close() override;
  std::string kind() const override { return "gamepad"; }
  std::string trouble() const override;
  std::string status() const override;

  static constexpr double kLookAgain = 0.5;  ///< s between two looks for one that is gone

 private:
  struct Live {
    std::string name;
    bool there = false;
    SpaceMouseState state;
    std::uint64_t events = 0;
  };
  Result<bool> open_first();
  Result<bool> open_found(const GamepadFound& found);
  void look_again(std::int64_t now_ns);
  void show();
  Live shown() const;

  const std::string which_;
  const Pose start_;
  const glm::dquat camera_;
  std::function<std::int64_t()> now_ns_;
  CameraView camera_now_;
  std::optional<GamepadPort> port_;
  std::optional<SpaceMouseMotion> motion_;
  GamepadFound found_;
  Live now_;
  std::int64_t advanced_ns_ = 0;
  std::int64_t looked_ns_ = 0;

  mutable std::mutex mutex_;
  Live shown_;
};

}  // namespace slosh
