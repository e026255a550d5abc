// How a fluid lies and how fluids are mixed, from the places of particles.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace slosh {

/// As fluid lies over a plane across up.
struct Spread {
  double area = 0.0;  ///< m²: where it is at least a particle deep it counts whole, else by its share
  /// 1 − the standard deviation of its depth over the mean, 0 at least: over what has fluid on all four
  /// sides, so that an edge counts as none. 0 where there is no such place.
  double evenness = 0.0;
};

/// `places`: m; `up`: unit; `spacing`: m. Told apart are places two spacings wide.
Spread spread_of(std::span<const glm::vec3> places, const glm::dvec3& up, double spacing);

/// Lacey's index of mixing (Lacey 1954): 0 = apart, 1 = as even as chance makes it, of samples two spacings
/// wide that hold a half of a whole one and more. `of_it`: 1 for the particles of the one, 0 for all others.
/// Not a number where one of the two is missing, or no sample is that full.
double mixing_index(std::span<const glm::vec3> places, std::span<const std::uint8_t> of_it, double spacing);

}  // namespace slosh
