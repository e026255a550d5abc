// The controllers in a person's hands, as a headset's runtime has them. No XR types here.
#pragma once

#include <cstdint>

#include "sim/math/pose.h"

namespace slosh {

enum class HandSide : std::uint8_t { kLeft, kRight };

/// Bits of HandReading::buttons.
enum HandButton : std::uint32_t {
  kHandTrigger = 1u << 0,    ///< more than half pulled
  kHandPrimary = 1u << 1,    ///< A or X, a trackpad's click
  kHandSecondary = 1u << 2,  ///< B or Y, the menu's
  kHandSqueeze = 1u << 3,    ///< more than half squeezed
};

/// One controller at one moment.
struct HandReading {
  bool tracked = false;  ///< false: the rest counts for nothing
  Pose pose;    ///< of the grip, in the room: origin in the palm, −z along the thumb's side of a fist
  Twist twist;  ///< room axes
  bool twist_known = false;
  float squeeze = 0.0f;  ///< 0–1
  float trigger = 0.0f;  ///< 0–1
  std::uint32_t buttons = 0;
};

/// Any thread, also beside the one that draws: a call waits for no picture, at most for another of these.
class HeadsetHands {
 public:
  virtual ~HeadsetHands() = default;
  /// Where the controller is now.
  virtual HandReading read(HandSide side) = 0;
  /// Shakes the hand: 0–1, for so many s. 0 stops.
  virtual void vibrate(HandSide side, double strength, double seconds) = 0;
};

}  // namespace slosh
