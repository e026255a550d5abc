// What the world needs of whoever moves its particles. sim/cpu and sim/cuda each have one.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/backend.h"
#include "sim/hash.h"
#include "sim/math/result.h"
#include "sim/run_constants.h"
#include "sim/viscosity/body_drag.h"
#include "sim/viscosity/implicit.h"
#include "sim/walls/guard_impulse.h"
#include "sim/world.h"

namespace slosh {

/// A sub-step is prepare(), forces(), advance(), in this order; wrenches() may be asked for after forces(). A
/// plan with kBodyDrag has drag() between forces() and advance(), after wrenches(); one with
/// kImplicitViscosity has solve_viscosity() there. Each runs those of the plan's passes that are its own, by
/// the backend's table. A GPU is only told what to do: it is waited for in wrenches() alone.
class ParticleEngine {
 public:
  virtual ~ParticleEngine() = default;

  /// Fluid and body particles in the order of their cells, under the bodies as they are now.
  virtual void prepare(std::span<const RigidBody> bodies) = 0;
  /// Pressure, and the forces on fluid and on bodies. `dt`: how long they will act, s.
  virtual void forces(double dt) = 0;
  /// The fluid moves on under those forces for `dt` s, while the bodies go from where they were in prepare()
  /// to `after`, and no further than to their walls.
  virtual void advance(double dt, std::span<const RigidBody> after) = 0;
  /// What the last forces() put on each body that the plan measures, about its centre of mass as it was in
  /// prepare(), with what its walls took from particles in the advance() before; the others get zero. One
  /// entry a body.
  virtual void wrenches(std::span<Wrench> out) = 0;
  /// With kBodyDrag after wrenches(), with kImplicitViscosity after solve_viscosity(): the drag on each free
  /// body by the same forces(); the others get none.
  virtual void body_drags(std::span<BodyDrag> out) const = 0;
  /// Adds to the viscous forces on the fluid what they lack when bodies' twists differ by `changes` (one a
  /// body, about its centre of mass) from the one that they had in prepare().
  virtual void drag(std::span<const Twist> changes) = 0;
  /// With kImplicitViscosity, after wrenches(), one entry a body: adds to the forces on the fluid the drag
  /// over `dt` s by the velocities that this ends with (viscosity/implicit.h), and to `wrenches` that on the
  /// bodies that move or are measured.
  virtual void solve_viscosity(double dt, std::span<const ViscousBody> bodies,
                               std::span<Wrench> wrenches) = 0;
  /// With kPressureSolve, after wrenches() and solve_viscosity(), one entry a body: solves for the pressures
  /// over `dt` s (pressure/solved_state.h), adds to the forces on the fluid what they differ by from the last
  /// step's, and to `wrenches` that on the bodies that move, and all of it on the fixed ones that are
  /// measured.
  virtual void solve_pressure(double dt, std::span<const ViscousBody> bodies, std::span<Wrench> wrenches) = 0;
  /// Multiplies every fluid velocity by `keep` (0–1).
  virtual void damp(float keep) = 0;

  /// Takes over changed viscosities, passes and gravity; the rest is as it was.
  virtual void set_constants(const RunConstants& constants) = 0;
  /// Sets the corrected model's constants from the next forces() on. set_constants() takes it back.
  virtual void set_correction(const CorrectionConstants& correction) = 0;

  /// All particles, in the engine's order, and what bodies have still to be given. False when the GPU failed.
  virtual bool save(ParticleState& out, ImpulseSums& impulses) const = 0;
  /// Takes a checked state over; particles that it lacks are out of the world. Clears status().
  virtual void restore(const ParticleState& state, const ImpulseSums& impulses) = 0;

  /// StatusBits so far. A GPU's may be those of the step before: the step does not wait for its last pass.
  virtual std::uint32_t status() const = 0;
  virtual std::uint32_t take_status() = 0;

  /// By id; a retired one gets index 255 and a position that means nothing. Both have the fluid's count of
  /// entries.
  virtual void fill(std::span<glm::vec3> positions, std::span<std::uint8_t> fluid_index) const = 0;
  /// The same, and where it lies on a GPU for who draws there: null where it is on none, or not shared, or
  /// where all places for that are looked at.
  virtual std::shared_ptr<const SharedParticles> fill_shared(std::span<glm::vec3> positions,
                                                             std::span<std::uint8_t> fluid_index) const {
    fill(positions, fluid_index);
    return nullptr;
  }
  /// Lets fill_shared() share; false where there is no GPU. Errors: it exports no memory, in words.
  virtual Result<bool> share() { return false; }
  /// The columns that the table says, in the order of the cells at the last sort, which the state itself
  /// fixes.
  virtual void add_to(Fingerprint& print) const = 0;
  virtual Diagnostics diagnostics() const = 0;
  /// Of the last sub-step (a GPU's passes: of the last one that is known to be over). `body` and `total` are
  /// not set.
  virtual StepTimes times() const = 0;
  /// Why kStatusDeviceLost was set, empty while all is well.
  virtual std::string failure() const { return {}; }
  /// Where the particles live, for people: "CPU, 2 threads", "CUDA, NVIDIA H200".
  virtual std::string name() const = 0;
};

/// The engine that `options` asks for. Errors: kCuda where no GPU answers, or one that lacks the memory.
Result<std::unique_ptr<ParticleEngine>> make_particle_engine(const RunConstants& constants,
                                                             const ParticleStart& start,
                                                             std::span<const RigidBody> bodies,
                                                             const WorldOptions& options);

}  // namespace slosh
