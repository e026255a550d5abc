// A tank that a paddle, held by one hand, is drawn through: every pass of the method at once.
#pragma once

#include "tests/support/tank.h"

namespace slosh::testing {

constexpr double kPaddleHeight = 0.09;  ///< m, of the paddle's middle at the start, at x = −0.05

/// Water with 2 cm of oil on it, a free paddle (body 1) and one grip on it. Nothing starts inside the paddle.
Tank stirred_tank(double wall_viscosity = 0.0);

/// Erases fluid within `half` of `center`, m.
void clear_box(SampledScene& sampled, const glm::vec3& center, const glm::vec3& half);

/// A grip at the body's origin.
void add_grip(Tank& tank, int body);

}  // namespace slosh::testing
