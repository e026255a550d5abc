// A ball that is let go under water in a tank: what it gains before anything separates behind it.
#pragma once

namespace slosh::report {

/// A ball at rest on the vertical axis of a square tank of water.
struct ReleasedBall {
  double radius = 0.02;     ///< m
  double share = 0.5;       ///< of the water's density
  double width = 0.16;      ///< m, the tank's, wall to wall
  double to_floor = 0.07;   ///< m, from the ball's middle
  double to_level = 0.09;   ///< m, to the free surface
  double viscosity = 1e-3;  ///< Pa·s
  double density = 1000.0;  ///< kg/m³, the water's
};

/// What goes along with it, over what it displaces: one half far from everything (Lamb 1932, art. 92), more
/// between walls, less under a free surface. By the images of its dipole, each seen as a uniform stream at
/// the ball: right to the sixth power of radius over distance.
double added_mass(const ReleasedBall& ball);

/// m/s², upwards, in the mean over `seconds` from the moment it is let go: buoyancy less the drag of its
/// boundary layer, Basset's force with Stokes', on ball and added mass. For ways of less than half a radius.
double mean_acceleration(const ReleasedBall& ball, double gravity, double seconds);

}  // namespace slosh::report
