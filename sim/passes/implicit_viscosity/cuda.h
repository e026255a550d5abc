// Implicit viscosity on the GPU (passes/implicit_viscosity/implicit.h): its memory, and what goes there and
// comes back.
#pragma once

#include <span>
#include <vector>

#include "sim/passes/implicit_viscosity/cuda_kernels.h"
#include "sim/passes/wrenches/cuda_sums.h"

namespace slosh::cuda {

class ViscousSolver {
 public:
  ViscousSolver() = default;
  ~ViscousSolver() {
    if (ready_) cudaEventDestroy(ready_);
  }
  ViscousSolver(const ViscousSolver&) = delete;
  ViscousSolver& operator=(const ViscousSolver&) = delete;

  /// Makes room where the plan has implicit viscosity. `sums` must outlive this.
  void plan(const Plan& plan, const ParticleStart& start, std::size_t body_count, const WrenchSums& sums,
            CallCheck& check);

  /// Writes the viscous pairs over `dt` s down; needs the densities only.
  void write_rows(const SolveSides& sides, float dt, CallCheck& check, cudaStream_t stream);
  /// After write_rows(): adds to the forces on the fluid, and to `wrenches` where bodies are measured or
  /// free: then it waits for the GPU. `before`: the bodies as they were placed.
  void solve(const SolveSides& sides, float dt, std::span<const ViscousBody> bodies,
             std::span<const RigidBody> before, std::uint32_t* status, std::span<Wrench> wrenches,
             CallCheck& check, cudaStream_t stream);
  /// By the last solve(), one a body: of those that moved in it.
  void drags(std::span<BodyDrag> out) const;

 private:
  void allocate_vectors(CallCheck& check);
  void send(std::span<const ViscousBody> bodies, std::span<const RigidBody> before, CallCheck& check,
            cudaStream_t stream);
  void read(std::span<const RigidBody> before, std::span<Wrench> wrenches);

  // What comes back in one copy, as in StepReport.
  Wrench* found_wrenches() const { return reinterpret_cast<Wrench*>(back_.data()); }
  DeviceWrench* fixed_wrenches() const { return reinterpret_cast<DeviceWrench*>(back_.data() + fixed_at_); }
  BodyDrag* found_drags() const { return reinterpret_cast<BodyDrag*>(back_.data() + drags_at_); }
  ViscousOutcome* outcome() const { return reinterpret_cast<ViscousOutcome*>(back_.data() + outcome_at_); }

  const WrenchSums* sums_ = nullptr;
  ViscousView view_;
  int blocks_ = 0;
  std::vector<BodyRange> placed_;      // one a body
  std::vector<std::int32_t> drag_of_;  // likewise: its place among the drags, below 0: none
  std::vector<char> moved_;            // one a body, in the last solve()
  cudaEvent_t ready_ = nullptr;

  DeviceBuffer<float4> pairs_, change_, residual_, product_, direction_, on_surface_;
  DeviceBuffer<std::uint32_t> counts_;
  DeviceBuffer<float4> walls_a_, block_a_;
  DeviceBuffer<float2> walls_b_, block_b_;
  DeviceBuffer<double> parts_;
  DeviceBuffer<DeviceViscousBody> bodies_;
  PinnedBuffer<DeviceViscousBody> sent_;
  DeviceBuffer<ViscousUnknown> unknowns_;
  DeviceBuffer<unsigned char> back_;
  PinnedBuffer<unsigned char> got_;
  std::size_t fixed_at_ = 0, drags_at_ = 0, outcome_at_ = 0;
};

}  // namespace slosh::cuda
