// A gamepad's node under /dev/input: which ones there are, and what one says.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "peer/devices/spacemouse_reports.h"
#include "sim/math/result.h"

struct libevdev;

namespace slosh {

/// One that is plugged in. Known by the kernel's own list (BTN_GAMEPAD and two axes), which everybody may
/// read.
struct GamepadFound {
  std::string path;    ///< "/dev/input/event5"
  std::string name;    ///< what it calls itself
  std::string serial;  ///< may be empty
};
/// All of them, in the order of their nodes' numbers. Any thread.
std::vector<GamepadFound> find_gamepads();

/// One open gamepad, claimed: two hands of this process never share one. One thread but for claimed().
///
/// Its state is told as a SpaceMouse's, so that the same motion follows it: x and y the left stick (right,
/// down), z the right trigger less the left, rx and ry the right stick's down and right, rz the right
/// shoulder button less the left; ±kSpaceMouseFull at the stops. Buttons from bit 0 on: south, east, north,
/// west, shoulders left and right, triggers left and right, select, start, mode, left and right stick.
class GamepadPort {
 public:
  /// Errors: it is claimed, gone, this user may not open it, or it is no gamepad.
  static Result<GamepadPort> open(const std::string& path);
  static bool claimed(const std::string& path);
  GamepadPort(GamepadPort&& other) noexcept;
  GamepadPort& operator=(GamepadPort&&) = delete;
  ~GamepadPort();

  /// What it says by now, without waiting; `events`: how many were new. False when the device is gone.
  bool take(SpaceMouseState& state, std::uint64_t& events);

 private:
  GamepadPort(int node, libevdev* device, std::string path);
  void tell(SpaceMouseState& state) const;

  int node_;
  libevdev* device_;
  std::string path_;
};

}  // namespace slosh
