// The worlds on which the two backends are compared: every pass of the method, both models, probes, particles
// that leave.
#pragma once

#include "sim/world.h"
#include "tests/support/tank.h"

namespace slosh::testing {

/// Two fluids in a tank, and a paddle that one hand draws through them (hand_at).
Tank stirred_tank(ParticleModel model);
/// The same with 20 Pa·s in both fluids and a paddle of 5 g: drag is most of what moves it.
Tank paddle_in_honey(ParticleModel model);

/// The tank of stirred_tank with `viscosity` in its lower fluid and `above` in its upper one, Pa·s, walls of
/// either's; beside the held paddle a box of half their density that nobody holds.
Tank thick_tank(double viscosity, double above);

/// Where the paddle's or the probe's hand is: to and fro along x, 5 cm to either side in a second, shaking
/// across.
HandleInput hand_at(double time, double height);

/// One fluid and one point probe (section 3) at height 0.05 m, held by a hand.
Tank probed_tank();

/// A free tank with a distance field, held by one hand (hand_at), whose fluid is thrown at a wall: particles
/// have to be kept from passing it from the third step on.
Tank thrown_tank();

/// A tank of about `particles` fluid particles half a metre deep at most, on an otherwise empty floor.
Tank pool(double particles);

}  // namespace slosh::testing
