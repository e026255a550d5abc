// What the passes on a GPU work on.
#pragma once

#include <span>
#include <vector>

#include "sim/cuda/body_exchange.h"
#include "sim/cuda/pass_clock.h"
#include "sim/cuda/step_report.h"
#include "sim/cuda/wall_clamps.h"
#include "sim/passes/bonds/cuda.h"
#include "sim/passes/implicit_viscosity/cuda.h"
#include "sim/passes/pass.h"
#include "sim/passes/pressure_solve/cuda.h"
#include "sim/passes/wrenches/cuda_sums.h"

namespace slosh::cuda {

/// A pass's function is NAME_on_cuda(CudaState&, const PassInputs&), in the folder of its name. It tells the
/// stream what to do and waits for nothing.
struct CudaState {
  CudaState(const RunConstants& constants, const ParticleStart& start, std::span<const RigidBody> bodies);
  ~CudaState();
  CudaState(const CudaState&) = delete;
  CudaState& operator=(const CudaState&) = delete;

  // A probe's force comes out of the last pass, and the report waits for it; not where the pressures' solve
  // fetches it.
  bool probes_report() const { return !probes.empty() && !constants.plan.has(PassId::kPressureSolve); }
  bool idle() const { return check.failed() || fluid.count() == 0; }
  SolveSides solve_sides() const {
    return {step,           constants.plan, kinds,  constants.kinds.front().viscosity,
            fluid.sorted(), fixed,          moving, sent.bodies()};
  }

  RunConstants constants;
  StepConstants step;
  std::vector<Probe> probes;
  std::size_t fluid_count;  // without probes
  mutable CallCheck check;
  cudaStream_t stream = nullptr;
  PassClock clock;
  bool sorted_ahead = false;  // the particles are in order for the next step's density

  FluidBuffers fluid;
  SurfaceBuffers fixed, moving;
  SortSpace space;
  DeviceBuffer<ParticleKind> kinds;
  DeviceBuffer<HeatKind> heat_kinds;      // kHeat; else empty
  BondBuffers bonds;                      // kBonds; else empty
  DeviceBuffer<float> body_temperatures;  // likewise
  WrenchSums sums;
  WallClamps clamps;
  StepReport report;
  ViscousSolver viscous;
  PressureSolver pressure;
  SentBodies sent;
  SentProbes sent_probes;
  std::vector<RigidBody> prepared;  // as the sub-step began
};

/// Eq 10–12 and the drag rates, to the report.
void find_wrenches(CudaState& state);

}  // namespace slosh::cuda
