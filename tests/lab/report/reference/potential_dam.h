// A dam break of a fluid without viscosity that is let go at once: what a dam's front is measured against
// where no gate and no film has a say.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace slosh::report {

/// A free surface over a floor at y = 0, from the wall at x = 0 to the tip, in bases of the dam; the fluid is
/// below it. Its mirror images below the floor and behind the wall close it.
struct DamSurface {
  double time = 0.0;  ///< in √(L/2g), L the base: as Martin and Moyce count it
  std::vector<glm::dvec2> points;
};

/// How fine it is, in bases.
struct DamGrid {
  double spacing = 0.08;  ///< along the surface
  double finest = 0.01;   ///< at the tip, and at least
  double tip = 0.03;      ///< a tongue is cut off, round, where it is thinner
};

/// Potential flow by boundary elements: from a column 1 wide and `height` high, let go at time 0, one surface
/// a step until `until`. Longuet-Higgins and Cokelet 1976, in the plane; linear elements, Runge and Kutta's
/// four stages, a new grid each step. Takes some seconds: 2 for a height of 2 until 3.3. At most 2 % of the
/// volume is lost with what is cut off. Throws Refused as outward_speeds does.
std::vector<DamSurface> potential_dam(double height, double until, const DamGrid& grid = {});

/// Where, in bases from the wall, the fluid is still `thickness` deep at `time`, within the times there are;
/// for less than the tip that was cut off its round end.
double front_at(const std::vector<DamSurface>& surfaces, double time, double thickness);

/// The speed across a surface, outwards, of a harmonic potential that has the values `potential` on it and
/// whose images are even. Sizes equal, two points at least. Throws Refused where these have no answer: two
/// neighbours in one place, something that is not a finite number.
std::vector<double> outward_speeds(const std::vector<glm::dvec2>& points,
                                   const std::vector<double>& potential);

}  // namespace slosh::report
