// What two people who carry the bucket felt, and what of the energy that came out of their hands nobody put
// in.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim/math/pose.h"

namespace slosh::coupling {

/// What one person felt, a row a sample; times rise.
struct Felt {
  std::vector<double> time;       ///< s, simulated
  std::vector<glm::dvec3> force;  ///< N, on the hand
  std::vector<double> put_in;     ///< J by then
  std::vector<double> height;     ///< m, of the hand
  std::vector<double> held;       ///< J that the spring to the grip has, by the force

  /// One more row; `hand` felt `on_hand` there. The bucket's couplings are 2000 N/m and 20 N·m/rad.
  void add(double at, const Pose& hand, const Wrench& on_hand);

 private:
  Pose last_;
  Wrench felt_;
};

/// Of `felt`, which has rows, the one at `time` or the next; the last where there is none.
std::size_t row_at(const Felt& felt, double time);

/// J that came out of both hands beyond what they put in, what their springs hold less than the weight alone
/// has them hold, and what a bucket that sank gave: the most at any moment, 0 or more. A hand counts from
/// when its force begins: until then a raise costs its person nothing, and takes nothing off what the other's
/// sinking end gives. (Where it did, 0.144 J were found of which none was made.) A spring that such a raise
/// stretched is credited to nobody. Not seen: what the water swings by and what is spilled; and where a
/// passivity controller holds a force back its spring counts as if it held less, by 0.06 J at most. Both have
/// rows.
double generated_by(const std::array<Felt, 2>& people);

/// Of force, against the same grip's over a round trip of nothing, from 3 s on; 1 = 100 %. NaN without a
/// reference.
double error_of(const Felt& felt, const Felt& reference);

}  // namespace slosh::coupling
