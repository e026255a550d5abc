// What the fluid does to bodies, summed in a fixed shape: which particles belong to which sum, and where the
// parts lie.
#pragma once

#include <span>
#include <vector>

#include "sim/cuda/device_particles.h"

namespace slosh::cuda {

/// Where a step's particles are.
struct SurfaceSides {
  const SurfaceBuffers& fixed;
  const SurfaceBuffers& moving;
};

/// What one solve is between, on the GPU.
struct SolveSides {
  const StepConstants& constants;
  const Plan& plan;
  const DeviceBuffer<ParticleKind>& kinds;
  float first_viscosity;  ///< Pa·s, of the first fluid
  const SortedFluid& fluid;
  const SurfaceBuffers& fixed;
  const SurfaceBuffers& moving;
  const DeviceBody* bodies;
};

class WrenchSums {
 public:
  /// Cuts the particles of the bodies that the plan measures into chunks; local order is body by body.
  void plan(const Plan& plan, const ParticleStart& start, std::size_t body_count, CallCheck& check);

  /// Of each sum, in the order of the sums.
  const std::vector<std::uint32_t>& bodies() const { return summed_; }
  /// Whether fixed bodies are among them, and which bodies, a flag each, on the GPU.
  bool fixed_measured() const { return fixed_measured_; }
  const std::uint8_t* wanted() const { return wanted_.data(); }

  /// Forces on the particles, `with_drag` with what those on free ones lose for their velocity; on fixed ones
  /// without pressure projection.
  void find_forces(const StepConstants& constants, const Plan& plan, float first_viscosity,
                   const SortedFluid& fluid, const SurfaceSides& sides, bool with_drag, CallCheck& check,
                   cudaStream_t stream) const;
  /// The particles' forces, to bodies().size() wrenches, and the drag of free ones' particles, the others'
  /// being zero, to as many. Either may be null.
  void sum(const SurfaceSides& sides, const DeviceBody* bodies, DeviceWrench* wrenches, BodyDrag* drags,
           CallCheck& check, cudaStream_t stream) const;

 private:
  DeviceBuffer<std::uint8_t> wanted_;  // one a body
  DeviceBuffer<WrenchChunk> chunks_;
  DeviceBuffer<WrenchRange> ranges_;
  DeviceBuffer<double> partial_;
  DeviceBuffer<std::uint32_t> done_;
  bool fixed_measured_ = false, moving_measured_ = false;
  std::vector<std::uint32_t> summed_;  // body of each range
};

}  // namespace slosh::cuda
