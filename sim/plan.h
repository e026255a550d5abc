// Which passes a scene needs, decided once and printed with reasons.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/passes/list.h"

namespace slosh {

/// A row of passes/list.h each, in the order in which they run.
enum class PassId : std::uint8_t {
#define SLOSH_ROW(id, ...) id,
  SLOSH_PASSES(SLOSH_ROW, SLOSH_ROW, SLOSH_ROW)
#undef SLOSH_ROW
};
#define SLOSH_ROW(...) +1
inline constexpr std::size_t kPassCount = SLOSH_PASSES(SLOSH_ROW, SLOSH_ROW, SLOSH_ROW);
#undef SLOSH_ROW

/// The id as golden files have it, "sort_fluid": the folder's name in sim/passes.
const char* name(PassId id);

class PassSet {
 public:
  constexpr PassSet() = default;
  constexpr PassSet(std::initializer_list<PassId> ids) {
    for (const PassId id : ids) set(id, true);
  }
  static constexpr PassSet all() {
    PassSet set;
    set.bits_ = ~0u;
    return set;
  }
  constexpr void set(PassId id, bool there) { bits_ = there ? bits_ | bit(id) : bits_ & ~bit(id); }
  constexpr bool has(PassId id) const { return bits_ & bit(id); }
  constexpr bool has_any_of(PassSet others) const { return bits_ & others.bits_; }

 private:
  static constexpr std::uint32_t bit(PassId id) { return 1u << static_cast<unsigned>(id); }
  std::uint32_t bits_ = 0;
};

struct Pass {
  PassId id;
  std::string reason;  ///< why it is there or not, with the numbers that decided it
};

/// What the step does for one scene at one spacing. See sim/README.md for each pass's reads and writes.
struct Plan {
  double spacing = 0.0;          ///< m
  double support_radius = 0.0;   ///< m, the paper's h
  double time_step = 0.0;        ///< s, fixed for the run
  std::string time_step_reason;  ///< which limit decided it
  double stiffness = 0.0;        ///< Eq 7's k of the heaviest fluid, m²/s² (= its sound speed²)
  ParticleModel model = ParticleModel::kCorrected;
  double fluid_depth = 0.0;  ///< m, the deepest column that volumes of fluid make, one on the other
  double fluid_drop = 0.0;   ///< m, from the highest fluid to the floor of the domain
  double driven_speed =
      0.0;  ///< m/s, the fastest that a start velocity, keys or a scripted hand make anything
  double sound_share =
      1.0;                 ///< of sound's own limit on the step, what density contrast and light bodies leave
  double tension = 0.0;    ///< share of Eq 7's negative pressure that is kept
  double max_speed = 0.0;  ///< m/s, above which a particle is slowed: speed_limit() of a sub-step
  std::vector<double> body_density;   ///< kg/m³, the constant density of each body's particles (section 4.1)
  std::vector<double> body_pressure;  ///< Pa, Eq 7 at that density

  bool implicit_viscosity = false;  ///< kImplicitViscosity runs whenever anything is viscous
  bool passes_stress = false;       ///< kFluidStress runs whenever anything is viscous; no wall mirrors
  bool waits_for_bodies = false;    ///< walls move, and nothing keeps the fluid from waiting for them
  int heat_steps = 1;               ///< steps that kHeat takes in one (passes/heat/conduction.h)
  int sub_steps = 1;                ///< that a step is made of, each time_step / sub_steps long

  PassSet runs;
  std::vector<int> wrench_bodies;  ///< bodies whose wrench is summed: free or measured
  std::vector<Pass> passes;        ///< those that run
  std::vector<Pass> left_out;      ///< those that this scene does not need

  bool has(PassId id) const { return runs.has(id); }
  bool has_fluid() const { return runs.has(PassId::kSortFluid); }
  /// Penetration clamp: particles are kept from passing walls (walls/penetration_clamp.h). The paper has no
  /// such thing.
  bool clamps_penetration() const { return has(PassId::kWalls) && model != ParticleModel::kPaper; }
  /// Nothing passes a wall: what leaves the domain went over an edge.
  bool walls_hold() const { return !has(PassId::kWalls) || clamps_penetration(); }
  /// The fluid moves on after the bodies only. `with_bodies`: they are solved in the same sub-step.
  bool fluid_waits(bool with_bodies) const {
    return runs.has_any_of({PassId::kImplicitViscosity, PassId::kPressureSolve}) ||
           (with_bodies && (has(PassId::kBodyDrag) || (clamps_penetration() && waits_for_bodies)));
  }
  bool viscous() const { return runs.has_any_of({PassId::kOneViscosity, PassId::kPairViscosity}); }
  /// Viscosity is among the explicit forces that a sub-step begins with.
  bool explicit_viscosity() const { return viscous() && !has(PassId::kImplicitViscosity); }
};

/// m/s: half a support radius in a sub-step of `time_step` s.
inline double speed_limit(const Plan& plan, double time_step) {
  return 0.5 * plan.support_radius / time_step;
}

/// Works out the plan for particles at `spacing` (m, > 0). `may_be_implicit`: without
/// implicit viscosity steps are shorter where a fluid is very viscous, as those of older saved worlds were.
Plan make_plan(const Scene& scene, double spacing, bool may_be_implicit = true);

/// Takes over changed viscosities of the scene's fluids: which viscous passes run. The time step stays. Needs
/// no mesh.
void plan_viscosity(const Scene& scene, Plan& plan);

/// The plan as the user reads it: numbers, then a line a pass, then what is left out and why.
std::string describe(const Plan& plan);

}  // namespace slosh
