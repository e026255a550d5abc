#include "sim/passes/pressure_solve/cuda.h"

#include "sim/cuda/state.h"
#include "sim/step_limits.h"

namespace slosh::cuda {

void PressureSolver::plan(const Plan& plan, const ParticleStart& start, std::size_t body_count,
                          const SortedFluid& fluid, const WrenchSums& sums, CallCheck& check) {
  if (!plan.has(PassId::kPressureSolve)) return;
  sums_ = &sums;
  check.ok(cudaEventCreateWithFlags(&ready_, cudaEventDisableTiming), "cudaEventCreate");
  if (check.failed()) return;
  view_.fluid = fluid.count;
  check.ok(most_pressure_blocks(view_.fluid, blocks_),
           "looking how many blocks the pressure projection may have");
  view_.surface = static_cast<std::uint32_t>(start.moving.size());
  view_.rows.room = fluid.near.room;
  view_.presses.room = row_room(plan);
  view_.touches.room = view_.presses.room / 2;
  view_.bodies = view_.surface ? static_cast<std::uint32_t>(body_count) : 0;
  placed_ = ranges_of(start.moving, body_count);
  allocate_vectors(check);
  bodies_.allocate(view_.bodies, check);
  sent_.allocate(view_.bodies, check);
  unknowns_.allocate(view_.bodies, check);
  fixed_at_ = body_count * sizeof(Wrench);
  probes_at_ = fixed_at_ + sums.bodies().size() * sizeof(DeviceWrench);
  back_.allocate(probes_at_ + start.probes.size() * sizeof(float4), check);
  got_.allocate(back_.size(), check);
  view_.body = bodies_.data();
  view_.unknown = unknowns_.data();
  view_.wrenches = reinterpret_cast<Wrench*>(back_.data());
  view_.first_probe = static_cast<std::uint32_t>(start.fluid_count);
  if (!start.probes.empty()) view_.probes = reinterpret_cast<float4*>(back_.data() + probes_at_);
}

void PressureSolver::allocate_vectors(CallCheck& check) {
  const std::size_t fluid = view_.fluid, threads = fluid * kTensorTeams.lanes(view_.fluid);
  for (DeviceBuffer<uint4>* buffer : {&by_own_, &by_other_})
    buffer->allocate(PressRows::places(threads, view_.rows.room), check);
  heads_.allocate(threads, check);
  if (view_.surface > 0) {
    touches_.allocate(PairRows::places(fluid, view_.touches.room), check);
    touch_counts_.allocate(fluid, check);
    presses_.allocate(PairRows::places(view_.surface, view_.presses.room), check);
    press_counts_.allocate(view_.surface, check);
  }
  for (DeviceBuffer<float4>* buffer : {&own_, &velocity_}) buffer->allocate(fluid, check);
  for (DeviceBuffer<float4>* buffer : {&on_surface_, &turning_}) buffer->allocate(view_.surface, check);
  for (DeviceBuffer<float2>* buffer : {&scale_, &pressing_}) buffer->allocate(fluid, check);
  for (DeviceBuffer<float>* buffer : {&flow_, &pressure_, &product_, &clipped_, &direction_})
    buffer->allocate(fluid, check);
  const std::size_t blocks = static_cast<std::size_t>(blocks_);
  parts_.allocate(kPressureParts * blocks, check);
  view_.rows.by_own = by_own_.data();
  view_.rows.by_other = by_other_.data();
  view_.rows.heads = heads_.data();
  view_.touches.pairs = touches_.data();
  view_.touches.counts = touch_counts_.data();
  view_.presses.pairs = presses_.data();
  view_.presses.counts = press_counts_.data();
  view_.own = own_.data();
  view_.scale = scale_.data();
  view_.velocity = velocity_.data();
  view_.on_surface = on_surface_.data();
  view_.turning = turning_.data();
  view_.flow = flow_.data();
  view_.pressure = pressure_.data();
  view_.product = product_.data();
  view_.clipped = clipped_.data();
  view_.direction = direction_.data();
  view_.pressing = pressing_.data();
  double* at = parts_.data();
  for (double** part : {&view_.parts.step, &view_.parts.turned, &view_.parts.clipped, &view_.parts.squares,
                        &view_.parts.pressing, &view_.parts.curvature}) {
    *part = at;
    at += blocks;
  }
}

void PressureSolver::push_by_last(const SolveSides& sides, CallCheck& check, cudaStream_t stream) {
  if (check.failed()) return;
  launch_pressure_rows(sides.constants, sides.kinds.data(), sides.fluid, sides.fixed.sorted(),
                       sides.moving.sorted(), view_, stream);
  check.launched("pressure pairs");
}

// The copy before has been made: solve() waits where there are bodies to send.
void PressureSolver::send(std::span<const ViscousBody> bodies, std::span<const RigidBody> before,
                          CallCheck& check, cudaStream_t stream) {
  if (view_.bodies == 0 || check.failed()) return;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    sent_[b] = {bodies[b], before[b].position, placed_[b].begin, placed_[b].end};
  check.ok(cudaMemcpyAsync(bodies_.data(), sent_.data(), bodies_.bytes(), cudaMemcpyHostToDevice, stream),
           "sending bodies for the pressure projection");
}

void PressureSolver::measure_fixed(const SolveSides& sides, CallCheck& check, cudaStream_t stream) {
  if (check.failed()) return;
  launch_surface_forces(sides.constants, sides.plan, sides.first_viscosity, sides.fluid, sides.fixed.sorted(),
                        sums_->wanted(), sides.fixed.local(), false, stream);
  check.launched("pressure on fixed bodies");
  sums_->sum({sides.fixed, sides.moving}, sides.bodies,
             reinterpret_cast<DeviceWrench*>(back_.data() + fixed_at_), nullptr, check, stream);
}

void PressureSolver::solve(const SolveSides& sides, double dt, std::span<const ViscousBody> bodies,
                           std::span<const RigidBody> before, const std::vector<Probe>& probes,
                           std::span<Wrench> wrenches, CallCheck& check, cudaStream_t stream) {
  send(bodies, before, check, stream);
  if (check.failed()) return;
  const double gravity = glm::length(sides.constants.gravity);
  const double back_in = density_time(sides.plan, gravity, dt);
  check.ok(launch_pressure_solve(sides.constants, sides.kinds.data(), static_cast<float>(dt),
                                 static_cast<float>(back_in), sides.fluid, sides.moving.sorted(),
                                 sides.moving.local(), view_, blocks_, stream),
           "the pressure projection");
  if (sums_->fixed_measured()) measure_fixed(sides, check, stream);
  if (view_.bodies == 0 && !sums_->fixed_measured() && probes.empty()) return;
  check.ok(cudaMemcpyAsync(got_.data(), back_.data(), back_.bytes(), cudaMemcpyDeviceToHost, stream),
           "fetching what pressures do to bodies");
  check.ok(cudaEventRecord(ready_, stream), "cudaEventRecord");
  check.ok(cudaEventSynchronize(ready_), "waiting for the pressure projection");
  if (!check.failed()) read(before, probes, wrenches);
}

void PressureSolver::read(std::span<const RigidBody> before, const std::vector<Probe>& probes,
                          std::span<Wrench> wrenches) const {
  for (std::size_t b = 0; b < placed_.size(); ++b) {
    if (placed_[b].end > 0) wrenches[b] = wrenches[b] + read_at<Wrench>(got_, 0, b);
  }
  for (std::size_t i = 0; i < sums_->bodies().size(); ++i) {
    const std::uint32_t b = sums_->bodies()[i];
    if (before[b].is_fixed()) wrenches[b] = wrenches[b] + read_at<DeviceWrench>(got_, fixed_at_, i).wrench();
  }
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const float4 f = read_at<float4>(got_, probes_at_, i);
    wrenches[probes[i].body].force += glm::dvec3(f.x, f.y, f.z);
  }
}

}  // namespace slosh::cuda

namespace slosh::passes {

void pressure_solve_on_cuda(cuda::CudaState& s, const PassInputs& in) {
  s.pressure.solve(s.solve_sides(), in.dt, in.bodies, s.prepared, s.probes, in.wrenches, s.check, s.stream);
}

}  // namespace slosh::passes
