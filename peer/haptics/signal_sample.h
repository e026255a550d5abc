// One hand's signals in one tick of the device loop, from the device's reading to what it was given, for who
// looks into a force that is not as it should be.
#pragma once

#include <cstdint>
#include <optional>

#include "sim/math/pose.h"

namespace slosh {

struct SignalSample {
  double time = 0.0;       ///< simulated s, as ServoSample's
  std::uint64_t tick = 0;  ///< of the device loop: none is missing but where samples were lost
  double wall = 0.0;       ///< s of the loop's clock since its first tick
  double period = 0.0;     ///< s of it since the tick before
  std::uint32_t device = 0;
  std::uint64_t reading = 0;  ///< of the device, in order: the same number is the same reading
  double age = 0.0;           ///< s since that was read
  bool engaged = false;
  std::optional<Pose> at_device;  ///< DeviceReport::at_device
  Pose hand;                      ///< world: after scale, clutch, camera and workspace
  Twist hand_twist;
  // On the hand, world: each as the one before it was changed.
  Wrench coupled;                  ///< spring and damper to the body, by the hand's hold
  Wrench guarded;                  ///< what the passivity controller let through
  Wrench wanted;                   ///< after gentle start, silence and jumps: what the limiter was asked for
  Wrench sent;                     ///< within the limits of size, rate and jerk: what the device was handed
  std::optional<Wrench> rendered;  ///< DeviceReport::rendered: of an earlier tick
};

}  // namespace slosh
