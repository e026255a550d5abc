// What the world needs of whoever steps its particles. sim/cpu and sim/cuda each have one.
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
#include "sim/saved_state.h"
#include "sim/world.h"

namespace slosh {

class ParticleEngine {
 public:
  virtual ~ParticleEngine() = default;

  /// One step of all particles under the bodies as they are now. `wrenches` (one a body) receives what the
  /// fluid puts on each body that the plan measures, about its centre of mass; the others get zero.
  virtual void step(std::span<const RigidBody> bodies, std::span<Wrench> wrenches) = 0;
  /// Multiplies every fluid velocity by `keep` (0–1).
  virtual void damp(float keep) = 0;

  /// Takes over changed viscosities, passes and gravity; the rest is as it was.
  virtual void set_constants(const RunConstants& constants) = 0;

  /// All particles, in the engine's order. False when the GPU failed.
  virtual bool save(ParticleState& out) const = 0;
  /// Takes a checked state over; particles that it lacks are out of the world. Clears status().
  virtual void restore(const ParticleState& state) = 0;

  /// StatusBits so far. A GPU's may be those of the step before: the step does not wait for its last pass.
  virtual std::uint32_t status() const = 0;
  virtual std::uint32_t take_status() = 0;

  /// By id; a retired one gets index 255 and a position that means nothing. Both have the fluid's count of
  /// entries.
  virtual void fill(std::span<glm::vec3> positions, std::span<std::uint8_t> fluid_index) const = 0;
  /// Ids, positions and velocities in the order of the cells at the last sort, which the state itself fixes.
  virtual void add_to(Fingerprint& print) const = 0;
  virtual Diagnostics diagnostics() const = 0;
  /// Of the last step (a GPU's passes: of the last one that is known to be over). `body` and `total` are not
  /// set.
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
