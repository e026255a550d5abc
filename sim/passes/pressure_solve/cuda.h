// Pressure projection on the GPU: its memory, and what goes there and comes back.
#pragma once

#include <span>
#include <vector>

#include "sim/passes/pressure_solve/cuda_kernels.h"
#include "sim/passes/wrenches/cuda_sums.h"

namespace slosh::cuda {

class PressureSolver {
 public:
  PressureSolver() = default;
  ~PressureSolver() {
    if (ready_) cudaEventDestroy(ready_);
  }
  PressureSolver(const PressureSolver&) = delete;
  PressureSolver& operator=(const PressureSolver&) = delete;

  /// Makes room where the plan solves for pressures. `fluid`: as allocated. `sums` must outlive this.
  void plan(const Plan& plan, const ParticleStart& start, std::size_t body_count, const SortedFluid& fluid,
            const WrenchSums& sums, CallCheck& check);

  /// After the force pass: writes the pressure pairs down, and adds what the last step's pressures push by.
  void push_by_last(const SolveSides& sides, CallCheck& check, cudaStream_t stream);
  /// After push_by_last(): adds to the forces on the fluid what the pressures over `dt` s differ by from the
  /// last step's, and to `wrenches` that on bodies in `moving`, all of it on the fixed ones that are
  /// measured, and the forces on `probes`: where there are such, it waits for the GPU. `before`: the bodies
  /// as they were placed.
  void solve(const SolveSides& sides, double dt, std::span<const ViscousBody> bodies,
             std::span<const RigidBody> before, const std::vector<Probe>& probes, std::span<Wrench> wrenches,
             CallCheck& check, cudaStream_t stream);

 private:
  void allocate_vectors(CallCheck& check);
  void send(std::span<const ViscousBody> bodies, std::span<const RigidBody> before, CallCheck& check,
            cudaStream_t stream);
  void measure_fixed(const SolveSides& sides, CallCheck& check, cudaStream_t stream);
  void read(std::span<const RigidBody> before, const std::vector<Probe>& probes,
            std::span<Wrench> wrenches) const;

  const WrenchSums* sums_ = nullptr;
  PressureView view_;
  int blocks_ = 0;
  std::vector<BodyRange> placed_;  // one a body
  cudaEvent_t ready_ = nullptr;

  DeviceBuffer<uint4> by_own_, by_other_;
  DeviceBuffer<uint2> heads_;
  DeviceBuffer<float4> touches_, presses_, own_, velocity_, on_surface_, turning_;
  DeviceBuffer<std::uint32_t> touch_counts_, press_counts_;
  DeviceBuffer<float2> scale_, pressing_;
  DeviceBuffer<float> flow_, pressure_, product_, clipped_, direction_;
  DeviceBuffer<double> parts_;
  DeviceBuffer<DevicePressedBody> bodies_;
  PinnedBuffer<DevicePressedBody> sent_;
  DeviceBuffer<PressedUnknown> unknowns_;
  // What comes back in one copy: wrenches one a body, those of the sums, forces on probes.
  DeviceBuffer<unsigned char> back_;
  PinnedBuffer<unsigned char> got_;
  std::size_t fixed_at_ = 0, probes_at_ = 0;
};

}  // namespace slosh::cuda
