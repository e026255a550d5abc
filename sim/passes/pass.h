// One pass of a sub-step: when a scene needs it, what it reads and writes, how the world runs it.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "sim/bodies/rigid_body.h"
#include "sim/fluid_extremes.h"
#include "sim/passes/implicit_viscosity/implicit.h"
#include "sim/plan.h"
#include "sim/world.h"

namespace slosh {

/// What passes ask of a scene. Worked out once a plan.
struct SceneFacts {
  const Scene& scene;
  const Plan& plan;  ///< its numbers and PassSet::runs of those rows that were decided before
  FluidExtremes fluids;
  int solids = 0;         ///< bodies with a surface
  int free_solids = 0;    ///< free ones of them
  int probes = 0;         ///< point probes
  int free_bodies = 0;    ///< probes among them
  int driven = 0;         ///< driven bodies, not among the free ones
  bool fluid = false;     ///< there are particles
  bool viscous = false;   ///< a fluid or a body has a viscosity
  bool one = false;       ///< all have the same
  bool implicit = false;  ///< implicit viscosity
  bool heat = false;      ///< temperatures or what has set will change
};

/// Whether a scene needs a pass, and why, or why not, with the numbers that decided it.
struct PassNeed {
  bool runs = false;
  std::string reason;
};
inline PassNeed needed(std::string why) {
  return {true, std::move(why)};
}
inline PassNeed left_out(std::string why) {
  return {false, std::move(why)};
}

/// What an engine's pass is called with besides its own state. One entry a body.
struct PassInputs {
  double dt = 0.0;                      ///< s of the sub-step
  std::span<const RigidBody> after;     ///< where the bodies end it, as far as that is known
  std::span<const Twist> changes;       ///< of the bodies' solved twists from those that they began it with
  std::span<const ViscousBody> bodies;  ///< as implicit viscosity and the pressures' solve have to know them
  std::span<Wrench> wrenches;           ///< on the bodies; added to
  bool look = false;                    ///< kBonds: who has set and who melted since is to be found
};

struct SubStep;

struct PassEntry {
  const char* words;  ///< for people
  const char* reads;  ///< columns and state, for sim/PASSES.md
  const char* writes;
  PassNeed (*need)(const SceneFacts&);
  /// Null: the engine's part, on the bodies as they are.
  void (*run)(World::Impl&, const SubStep&) = nullptr;
};

/// The table's row.
const PassEntry& entry(PassId id);
/// The pass whose loop runs it; itself where it has its own.
PassId runs_in(PassId id);
/// Whether engines have a part of their own for it.
bool on_engine(PassId id);

}  // namespace slosh
