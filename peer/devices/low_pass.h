// Takes out of a device's force what is above the band that a user wants.
#pragma once

#include <cmath>

#include "sim/math/pose.h"

namespace slosh {

/// One pole, exact at every period: −3 dB at `hz`, 6 dB an octave. A zero wrench passes at once, whatever was
/// before: whoever lets go lets go. One thread; no allocation.
class LowPass {
 public:
  /// `hz` 0: everything passes. `period`, s, between two calls.
  LowPass(double hz, double period) : keep_(hz > 0.0 ? std::exp(-2.0 * kPi * hz * period) : 0.0) {}

  Wrench pass(const Wrench& wanted) noexcept {
    const bool nothing = wanted.force == glm::dvec3(0.0) && wanted.torque == glm::dvec3(0.0);
    const double keep = nothing ? 0.0 : keep_;
    last_ = {wanted.force + keep * (last_.force - wanted.force),
             wanted.torque + keep * (last_.torque - wanted.torque)};
    return last_;
  }

  /// s: what the filter holds a slow force back by, 1/(2π·hz). A spring behind it takes as much more of the
  /// device's damping as one sampled 2·lag() more seldom: the real part of K/(jω(1 + jω·lag)) is −K·lag at
  /// most.
  static double lag(double hz) { return hz > 0.0 ? 1.0 / (2.0 * kPi * hz) : 0.0; }

 private:
  static constexpr double kPi = 3.14159265358979323846;
  double keep_;
  Wrench last_;
};

}  // namespace slosh
