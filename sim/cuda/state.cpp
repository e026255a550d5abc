#include "sim/cuda/state.h"

#include <algorithm>

namespace slosh::cuda {

CudaState::CudaState(const RunConstants& constants_in, const ParticleStart& start,
                     std::span<const RigidBody> bodies)
    : constants(constants_in),
      step(step_constants(constants_in)),
      probes(start.probes),
      fluid_count(start.fluid_count) {
  check.ok(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "cudaStreamCreate");
  clock.start(check);
  fluid.allocate(start.particles.kind.size(), constants, step.grid, check);
  fixed.allocate(start.fixed, step.grid, check);
  moving.allocate(start.moving, step.grid, check);
  const std::size_t largest = std::max({start.particles.size(), start.fixed.size(), start.moving.size()});
  space.allocate(static_cast<std::uint32_t>(largest), step.grid, check);
  kinds.upload(constants.kinds, check);
  if (constants.plan.has(PassId::kHeat)) {
    heat_kinds.upload(constants.heat.kinds, check);
    body_temperatures.upload(constants.heat.bodies, check);
  }
  if (constants.plan.has(PassId::kBonds)) bonds.allocate(start.particles.kind.size(), check);
  sums.plan(constants.plan, start, bodies.size(), check);
  clamps.plan(constants, start, bodies.size(), check);
  viscous.plan(constants.plan, start, bodies.size(), sums, check);
  pressure.plan(constants.plan, start, bodies.size(), fluid.sorted(), sums, check);
  report.plan(sums.bodies().size(), clamps.handed_bytes(), probes.size(), check);
  sent.allocate(bodies.size(), check);
  sent_probes.allocate(probes, check);
}

CudaState::~CudaState() {
  if (!stream) return;
  cudaStreamSynchronize(stream);
  cudaStreamDestroy(stream);
}

}  // namespace slosh::cuda
