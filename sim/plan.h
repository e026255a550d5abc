// Which passes a scene needs, decided once and printed with reasons.
#pragma once

#include "scenes/scene.h"

#include <string>
#include <vector>

namespace slosh {

struct Pass {
  std::string name;
  std::string reason;  ///< why it is there, with the numbers that decided it
};

/// What the step does for one scene at one spacing. See sim/README.md for each pass's reads and writes.
struct Plan {
  double spacing = 0.0;         ///< m
  double support_radius = 0.0;  ///< m, the paper's h
  double time_step = 0.0;       ///< s, fixed for the run
  double stiffness = 0.0;       ///< Eq 7's k, m²/s² (= sound speed²)
  double max_speed = 0.0;       ///< m/s, above which a particle is slowed (support radius a step)

  bool has_fluid = false;
  bool viscosity = false;          ///< Eq 6 or 9: something in the scene has μ > 0
  bool one_viscosity = false;      ///< every pair has the same μ: Eq 6, no per-particle μ
  bool boundary_viscosity = false; ///< a body's side of Eq 9 is not 0
  bool boundary = false;           ///< body particles near fluid: Eq 5 and 9 against them
  bool body_wrench = false;        ///< Eq 10–12 for the bodies in `wrench_bodies`
  bool rigid_dynamics = false;     ///< Eq 13–14
  bool contacts = false;           ///< two bodies can touch, one of them free
  bool couplings = false;          ///< at least one grip
  std::vector<int> wrench_bodies;  ///< bodies whose wrench is summed: free or measured
  std::vector<Pass> passes;        ///< in the order they run
  std::vector<Pass> left_out;      ///< passes that the method has and this scene does not need
};

/// Works out the plan. `sampled` may be a coarse sampling: only its spacing and counts being zero or not matter.
Plan make_plan(const Scene& scene, double spacing);

/// The plan as the user reads it: numbers, then a line a pass, then what is left out and why.
std::string describe(const Plan& plan);

}  // namespace slosh
