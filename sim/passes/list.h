// The passes of a sub-step, a row each: what a plan lists, what a step runs, what a profile tells.
#pragma once

/// In the order in which they run. A pass lives in the folder of its name: `pass.cpp` says when a scene needs
/// it, what it reads and writes, and how the world runs it.
///  - OWN(id, name): the engine runs it, by NAME_on_cpu() and NAME_on_cuda() of that folder.
///  - FUSED(id, name, into): the loop of pass `into` does it beside its own, where the plan has it.
///  - WORLD(id, name): no engine has a part in it, or only where pass.cpp calls it.
#define SLOSH_PASSES(OWN, FUSED, WORLD)                 \
  WORLD(kRestDensity, rest_density)                     \
  OWN(kSortFluid, sort_fluid)                           \
  OWN(kPlaceBodies, place_bodies)                       \
  OWN(kHeat, heat)                                      \
  OWN(kDensity, density)                                \
  FUSED(kFluidStress, fluid_stress, kDensity)           \
  OWN(kPressureForce, pressure_force)                   \
  FUSED(kOneViscosity, one_viscosity, kPressureForce)   \
  FUSED(kPairViscosity, pair_viscosity, kPressureForce) \
  FUSED(kWalls, walls, kPressureForce)                  \
  OWN(kBonds, bonds)                                    \
  OWN(kWrenches, wrenches)                              \
  WORLD(kReadWrenches, read_wrenches)                   \
  WORLD(kPredictBodies, predict_bodies)                 \
  OWN(kImplicitViscosity, implicit_viscosity)           \
  OWN(kPressureSolve, pressure_solve)                   \
  FUSED(kCouplings, couplings, kSolveBodies)            \
  FUSED(kJoints, joints, kSolveBodies)                  \
  FUSED(kContacts, contacts, kSolveBodies)              \
  WORLD(kSolveBodies, solve_bodies)                     \
  OWN(kBodyDrag, body_drag)                             \
  WORLD(kMoveBodies, move_bodies)                       \
  OWN(kIntegrateFluid, integrate_fluid)                 \
  WORLD(kDamp, damp)
