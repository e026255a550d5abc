// Whether hands that stand still feel what they should at rest: a weight, whatever the fluid's viscosity.
#pragma once

#include <string>
#include <vector>

#include "tests/lab/verbs/scripted_run.h"

namespace slosh {

/// A stretch of a run in which a hand stands still, and what it feels by the end of it.
struct RestForce {
  double from = 0.0, to = 0.0;  ///< s
  double force = 0.0;           ///< N, mean over its last half
  double change = 0.0;          ///< N, from the mean over its first half to that
};

/// Those of a hand before its first motion and after its last, where they are long enough to come to rest in;
/// one that never moves has one.
std::vector<RestForce> rest_forces(const WrenchSeries& felt, const std::vector<Pose>& poses);

/// What to say of a hand whose force at rest differs by more than a percent between runs that differ by
/// viscosity alone: that its fluid had not settled, where the force was still changing by as much, else that
/// its particles came to rest otherwise. Empty where it does not differ. One entry a run.
std::string unsettled_text(const std::string& hand, const std::vector<std::vector<RestForce>>& runs);

}  // namespace slosh
