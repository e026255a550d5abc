// Which passes a scene needs, decided once and printed with reasons.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.h"

namespace slosh {

struct Pass {
  std::string name;
  std::string reason;  ///< why it is there, with the numbers that decided it
};

/// What the step does for one scene at one spacing. See sim/README.md for each pass's reads and writes.
struct Plan {
  double spacing = 0.0;          ///< m
  double support_radius = 0.0;   ///< m, the paper's h
  double time_step = 0.0;        ///< s, fixed for the run
  std::string time_step_reason;  ///< which limit decided it
  double stiffness = 0.0;        ///< Eq 7's k, m²/s² (= sound speed²)
  ParticleModel model = ParticleModel::kConsistent;
  double fluid_depth = 0.0;  ///< m, the deepest column that a fluid could stand in at the start
  double fluid_drop = 0.0;   ///< m, from the highest fluid to the floor of the domain
  double sound_share =
      1.0;                 ///< of sound's own limit on the step, what density contrast and light bodies leave
  double tension = 0.0;    ///< share of Eq 7's negative pressure that is kept
  double max_speed = 0.0;  ///< m/s, above which a particle is slowed (half a support radius a step)
  std::vector<double> body_density;   ///< kg/m³, the constant density of each body's particles (section 4.1)
  std::vector<double> body_pressure;  ///< Pa, Eq 7 at that density

  bool has_fluid = false;
  bool viscosity = false;          ///< Eq 6 or 9: something in the scene has μ > 0
  bool one_viscosity = false;      ///< every pair has the same μ: Eq 6, no per-particle μ
  bool boundary = false;           ///< body particles near fluid: Eq 5 and 9 against them
  bool body_wrench = false;        ///< Eq 10–12 for the bodies in `wrench_bodies`
  bool rigid_dynamics = false;     ///< Eq 13–14
  bool contacts = false;           ///< two bodies can touch, one of them free
  bool couplings = false;          ///< at least one grip
  std::vector<int> wrench_bodies;  ///< bodies whose wrench is summed: free or measured
  std::vector<Pass> passes;        ///< in the order they run
  std::vector<Pass> left_out;      ///< passes that the method has and this scene does not need
};

/// Works out the plan for particles at `spacing` (m, > 0).
Plan make_plan(const Scene& scene, double spacing);

/// Takes over changed viscosities of the scene's fluids: which viscous passes run. The time step stays. Needs
/// no mesh.
void plan_viscosity(const Scene& scene, Plan& plan);

/// The plan as the user reads it: numbers, then a line a pass, then what is left out and why.
std::string describe(const Plan& plan);

}  // namespace slosh
