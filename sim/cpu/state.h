// What the passes on the CPU work on.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "sim/cpu/passes.h"
#include "sim/particle_engine.h"
#include "sim/passes/bonds/cpu.h"
#include "sim/passes/pass.h"
#include "sim/passes/pressure_solve/cpu_pairs.h"

namespace slosh {

/// A pass's function is NAME_on_cpu(CpuState&, const PassInputs&), in the folder of its name.
struct CpuState {
  CpuState(const RunConstants& constants, const ParticleStart& start, std::span<const RigidBody> bodies,
           int threads);

  /// What only one pass needs from sub-step to sub-step: made when first asked for.
  template <class T>
  T& memory(PassId id) {
    std::shared_ptr<void>& own = memory_[static_cast<std::size_t>(id)];
    if (!own) own = std::make_shared<T>();
    return *static_cast<T*>(own.get());
  }
  void reshape(const ReshapedBody& as);
  void sum_wrenches(const BodySurface& surface, std::span<Wrench> wrenches, std::span<BodyDrag> drags);

  // Probes are particles that their body carries: their state goes in before the passes, the force comes out
  // after.
  void carry_probes_in();
  void carry_probe_forces_out(std::span<Wrench> out) const;

  PassContext context;
  ThreadTeam team;
  FluidParticles fluid;
  GatheredColumns scratch;
  BodySurface fixed, moving;
  std::vector<Probe> probes;
  std::size_t fluid_count;   // without probes
  std::vector<char> wanted;  // one a body: its wrench is summed
  bool fixed_measured = false;
  std::vector<DistanceField> fields;  // of the bodies that particles are clamped against
  std::vector<ClampSolid> clamp_solids;
  ImpulseSums impulses;           // what walls take in this sub-step
  std::vector<Wrench> taken;      // and what they took in the one before, one a body
  std::vector<RigidBody> bodies;  // as the sub-step began
  std::vector<glm::dvec3> centers;
  std::vector<Wrench> found;    // one a body, by this sub-step
  std::vector<BodyDrag> drags;  // one a body, by the same
  FluidPress pairs;             // of the density pass
  CpuBonds bonds;               // kBonds

 private:
  std::array<std::shared_ptr<void>, kPassCount> memory_;
};

}  // namespace slosh
