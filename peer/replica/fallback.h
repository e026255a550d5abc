// What takes the replica's place where it is wrong about the body.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace slosh {

/// A passivity controller that fires all the time says that the replica is wrong about the body. Then hands
/// feel a damped spring to the host's last update, until the controllers have been quiet for a while.
struct Fallback {
  bool fires = false;   ///< a controller did, in this tick
  double firing = 0.0;  ///< share of ticks lately
  double quiet = 0.0;   ///< s since a controller fired
  bool fallen_back = false;
  double spring = 0.0;      ///< share of the damped spring, 0–1
  std::uint64_t fired = 0;  ///< ticks in which a controller did

  void restart() noexcept {
    firing = quiet = spring = 0.0;
    fallen_back = false;
  }
  void note(bool controller_fires) noexcept { fires = fires || controller_fires; }
  /// A tick of `dt` s ends.
  void advance(double dt) noexcept {
    firing += (1.0 - std::exp(-dt / kFiringMemory)) * ((fires ? 1.0 : 0.0) - firing);
    quiet = fires ? 0.0 : quiet + dt;
    if (fires) fired += 1;
    fires = false;
    if (!fallen_back && firing > kFiresTooOften) fallen_back = true;
    if (fallen_back && quiet > kQuietTime) fallen_back = false;
    spring = std::clamp(spring + (fallen_back ? dt : -dt) / kChange, 0.0, 1.0);
  }

  static constexpr double kFiringMemory = 0.5;   ///< s over which the share of ticks is averaged
  static constexpr double kFiresTooOften = 0.5;  ///< share of ticks that is too much
  static constexpr double kQuietTime = 3.0;      ///< s after which the replica is tried again
  static constexpr double kChange = 0.5;         ///< s over which one goes over into the other
};

}  // namespace slosh
