// Between the world's time and the clock on the wall, where a world is slower than real time.
#pragma once

#include "sim/math/pose.h"

namespace slosh {

/// A world that is slower than this, simulated s a s, counts as this slow where velocities are converted: a
/// hand would seem to fly.
constexpr double kSlowestFelt = 0.05;

/// A velocity told by a clock of which a second is `pace` s (> 0) of another, by that other.
inline Twist sped_up(const Twist& twist, double pace) {
  return {twist.linear / pace, twist.angular / pace};
}

}  // namespace slosh
