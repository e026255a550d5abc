// A backend's table: which of its functions carries out which of the plan's passes.
#pragma once

#include <span>

#include "sim/plan.h"
#include "sim/stopwatch.h"
#include "sim/world.h"

namespace slosh {

/// The part of a sub-step that a pass belongs to: ParticleEngine's calls.
enum class SubStepPart { kPrepare, kForces, kViscosity, kPressure, kDrag, kAdvance };

/// One row. `covers` has several passes where the backend does them in one loop over the neighbours; the loop
/// then leaves out those that the plan has not.
template <class Engine>
struct PassRow {
  SubStepPart part;
  PassSet covers;
  void (Engine::*run)(double dt);
  double StepTimes::* time;
};

/// Runs the rows of one part that the plan has, in the table's order. `time` receives what each took, unless
/// null.
template <class Engine>
void run_passes(Engine& engine, std::span<const PassRow<Engine>> table, SubStepPart part, const Plan& plan,
                double dt, StepTimes* times) {
  Stopwatch watch;
  for (const PassRow<Engine>& row : table) {
    if (row.part != part || !plan.runs.has_any_of(row.covers)) continue;
    (engine.*row.run)(dt);
    if (times) times->*row.time += watch.lap();
  }
}

/// Every pass of the particles is carried out by one row and no more.
template <class Engine, std::size_t count>
constexpr bool covers_all_particle_passes(const PassRow<Engine> (&table)[count]) {
  for (const PassId id : {PassId::kSortFluid, PassId::kPlaceBodies, PassId::kDensity, PassId::kFluidStress,
                          PassId::kPressureForce, PassId::kOneViscosity, PassId::kPairViscosity,
                          PassId::kWalls, PassId::kWrenches, PassId::kBodyDrag, PassId::kImplicitViscosity,
                          PassId::kPressureSolve, PassId::kIntegrateFluid}) {
    int rows = 0;
    for (const PassRow<Engine>& row : table) rows += row.covers.has(id);
    if (rows != 1) return false;
  }
  return true;
}

}  // namespace slosh
