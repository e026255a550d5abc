// A tank that a paddle, held by one hand, is drawn through: every pass of the method at once.
#pragma once

#include "sim/world.h"
#include "tests/support/tank.h"

namespace slosh::testing {

constexpr double kPaddleHeight = 0.09;  ///< m, of the paddle's middle at the start, at x = −0.05

/// Water with 2 cm of oil on it, a free paddle (body 1) and one grip on it. Nothing starts inside the paddle.
Tank stirred_tank(double wall_viscosity = 0.0);

/// Erases fluid within `half` of `center`, m.
void clear_box(SampledScene& sampled, const glm::vec3& center, const glm::vec3& half);

/// A grip at the body's origin.
void add_grip(Tank& tank, int body);

/// A free point probe of 20 g at `position`, m, without a grip. Returns the body's index.
int add_probe(Tank& tank, const glm::dvec3& position);

/// The tank as it is planned, on the CPU.
World world_of(const Tank& tank, int threads = 1);

/// A hand that draws the stirred tank's paddle through it at 0.2 m/s, swaying sideways.
HandleInput paddle_hand(double time);

}  // namespace slosh::testing
