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
#include "sim/passes/body_drag/body_drag.h"
#include "sim/passes/bonds/bonds.h"
#include "sim/passes/implicit_viscosity/implicit.h"
#include "sim/passes/pass.h"
#include "sim/run_constants.h"
#include "sim/walls/clamp_impulse.h"
#include "sim/world.h"

namespace slosh {

/// A body with another surface, because it was cut or made whole.
struct ReshapedBody {
  std::size_t body = 0;
  std::size_t first = 0;                         ///< of its particles among ParticleStart::moving
  std::span<const SurfaceParticle> particles{};  ///< as many as it had there
  const DistanceField* clamp = nullptr;          ///< on the grid that it had
  /// m, world: by how much its centre of mass went back, from where it had its impulses
  glm::dvec3 recentred{0.0};
};

/// A sub-step is begin(), then run() for each pass of the world's schedule that is an engine's. A GPU is only
/// told what to do: it is waited for in wrenches() and in the two solves alone.
class ParticleEngine {
 public:
  virtual ~ParticleEngine() = default;

  /// A sub-step of `dt` s from the bodies as they are now.
  virtual void begin(std::span<const RigidBody> bodies, double dt) = 0;
  /// Carries out a pass that is the engine's own (passes/list.h), with what the plan has of those that are
  /// fused into it.
  virtual void run(PassId id, const PassInputs& inputs) = 0;
  /// What kWrenches found on each body that the plan measures, about its centre of mass as the sub-step
  /// began, with what its walls took from particles when they moved last; the others get zero. One entry a
  /// body.
  virtual void wrenches(std::span<Wrench> out) = 0;
  /// With kBodyDrag after wrenches(), with kImplicitViscosity after that: the drag on each free body, by the
  /// same sub-step; the others get none.
  virtual void body_drags(std::span<BodyDrag> out) const = 0;
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

  /// Between two sub-steps.
  virtual void reshape(const ReshapedBody& as) = 0;

  /// With kBonds who is bound to whom, by id; else an empty table. False when the GPU failed.
  virtual bool save_bonds(BondTable& out) const = 0;
  /// Takes a checked table over, after restore().
  virtual void restore_bonds(const BondTable& bonds) = 0;

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
  /// The same, brought when it is asked for, at any time and on any thread: empty where fill_shared() gives
  /// null, and `on_gpu` with it.
  virtual ParticleFetch fill_later(std::shared_ptr<const SharedParticles>& on_gpu) const {
    on_gpu = nullptr;
    return {};
  }
  /// Lets fill_shared() share; false where there is no GPU. Errors: it exports no memory, in words.
  virtual Result<bool> share() { return false; }
  /// The columns that the table says, in the order of the cells at the last sort, which the state itself
  /// fixes.
  virtual void add_to(Fingerprint& print) const = 0;
  virtual Diagnostics diagnostics() const = 0;
  /// The times of its passes in the last sub-step that was timed and is known to be over, where it runs them
  /// later than it is asked to; null where a pass is over when run() is.
  virtual const StepTimes* times() const { return nullptr; }
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
