// When the pressure projection's iterations end (solved_state.h has the system).
#pragma once

namespace slosh {

/// Iterations end when the residual is below this share of the first one,
inline constexpr double kPressureTolerance = 0.03;
/// or below this compression, root mean square over the particles that press (at 1e-4 the weight of a still
/// tank jitters by 0.37 %, so by 0.03; half as many iterations cost next to nothing less),
inline constexpr double kPressureFloor = 3e-5;
/// and here whatever is left: the next step begins with what this one found, and undoes a share of what is
/// compressed. With 8 a released column of 32 layers rings for a second.
inline constexpr int kMaxPressureIterations = 20;

/// How one solve went.
struct PressureReport {
  int iterations = 0;
  double left = 0.0;  ///< compression that the step leaves, root mean square over the particles that press
};

}  // namespace slosh
