// Comparisons of two worlds, printed with their tolerances.
#pragma once

#include <cstdint>

#include "tests/cross/worlds.h"

namespace slosh::testing {

/// Of comparisons that failed so far.
int failures();
/// Prints the value with its limit; not-a-number fails.
void expect_at_most(const char* what, double value, double limit);
void expect_true(const char* what, bool fine);

/// One thread where it is the CPU's. Exits where there is no such world.
World world_on(Backend backend, const Tank& tank, Plan plan);
World world_on(Backend backend, const Tank& tank);
/// With the one hand where hand_at() has it.
void step(World& world, double hand_height);

struct View {
  Snapshot snapshot;
  Diagnostics sums;
  explicit View(const World& world) : sums(world.diagnostics()) { world.fill(snapshot); }
};

/// Squeezed by 3 % and shaken, so that every term of the first step is at work.
Tank shaken(Tank tank);

/// What two worlds may differ by, each check by its own scale.
struct Tolerance {
  double particle;  ///< the one furthest from itself, in spacings
  double rest;      ///< everything else: particles' root mean square, sums, what bodies feel
  Tolerance(double all) : particle(all), rest(all) {}
  Tolerance(double one, double others) : particle(one), rest(others) {}
};

/// Particle by particle, by their sums, and by what bodies feel.
void compare_worlds(const World& cpu, const World& gpu, const Tolerance& tolerance);
/// After one step from the same start the two differ by rounding alone; velocities show in momentum and
/// energy.
void compare_steps(const char* name, const Tank& tank, const Plan& plan, int steps,
                   const Tolerance& tolerance);
/// On the GPU, after each step: what the fluid's momentum changed by is what bodies and gravity gave. The
/// worst step, over weight · dt. No solve may be cut short.
void compare_momenta(const Tank& tank, const Plan& plan, int steps, double tolerance);
/// The same hash each time on the GPU, whatever else is going on.
void repeat(const char* name, const Tank& tank, double hand_height, int steps = 300);

/// Saved after 100 steps and restored on the GPU, and from one backend to the other, both ways: one step each
/// to `tolerance`.
void compare_restored(const char* name, const Tank& tank, double hand_height,
                      const Tolerance& tolerance = 1e-5);

/// viscous_worlds.cpp: implicit viscosity; one step of it.
void compare_viscous();
void compare_viscous_step();
/// slipping_worlds.cpp: free-slip walls.
void compare_slipping();
/// warm_worlds.cpp: heat, setting and bonds.
void compare_warm();
/// The same file: what comes and goes.
void compare_coming();
/// cut_worlds.cpp: bodies that are cut.
void compare_cut();
/// pressed_worlds.cpp: pressure projection; single steps of it.
void compare_pressed();
void compare_pressed_steps();

}  // namespace slosh::testing
