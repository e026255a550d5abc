// What has set holds together: bond-based peridynamics (Silling 2000) between particles that have set.
//
// A bond pulls and pushes along the line between its two by its strain, so that momentum and angular momentum
// are kept to rounding; it is torn for good above a stated strain, and gone where one of its two melts. Both
// of a pair have it, each in its own row: who reads a row writes to nobody else, and both see the same
// distance and so decide alike.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/math/host_device.h"

namespace slosh {

/// Of a particle. A lattice has 18 within kBondReach, a settled fluid 14 to 20.
inline constexpr std::uint32_t kMaxBonds = 24;
/// Spacings from one to the other when both have set. Reaching 6 neighbours along the axes of a lattice and
/// 12 along its faces' diagonals, bonds alike make it nearly isotropic: its C₁₁ is 1.14 times that of an
/// isotropic solid (with the 8 corners, 0.72).
inline constexpr float kBondReach = 1.6f;
/// A particle counts as set from a cure of 1 on, and no more below this.
inline constexpr float kMelted = 0.5f;

struct Bond {
  std::uint32_t other = 0;  ///< id
  float rest = 0.0f;        ///< m
};

/// Rows of kMaxBonds each, by id.
struct BondTable {
  std::vector<Bond> bonds;
  std::vector<std::uint8_t> count;
  std::vector<std::uint8_t> set;  ///< 1: it has set
  std::vector<float> weight;      ///< bond_weight() of each; a bond counts by both's

  void resize(std::size_t particles) {
    bonds.resize(particles * kMaxBonds);
    count.resize(particles);
    set.resize(particles);
    weight.resize(particles, 1.0f);
  }
  Bond* row(std::size_t id) { return bonds.data() + id * kMaxBonds; }
  const Bond* row(std::size_t id) const { return bonds.data() + id * kMaxBonds; }
};

/// N for each unit of strain, of a bond that makes a solid of `modulus`, Pa (Young's), of particles `spacing`
/// m apart: 12 V E over the lengths of a particle's bonds, for a Poisson's ratio of a quarter.
double bond_stiffness(double modulus, double spacing);
/// m, of a particle's bonds in a lattice.
double bond_lengths(double spacing);

/// A particle at a surface has fewer bonds, and what it lies in would be too soft; so those count more. With
/// the fourth root of either's lack both, a face of a lattice has the modulus of its middle, and a sheet of
/// one layer 1.09 times that. `lengths`: m, of its own bonds; `whole`: bond_lengths().
SLOSH_HD inline float bond_weight(float lengths, float whole) {
  const float share = lengths / whole;
  return std::sqrt(std::sqrt(1.0f / (share > 0.1f ? share : 0.1f)));
}

/// Whether a particle counts as set, by its cure and by whether it did.
SLOSH_HD inline bool counts_as_set(float cure, bool did) {
  return cure >= 1.0f || (did && cure >= kMelted);
}

}  // namespace slosh
