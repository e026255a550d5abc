#include "sim/passes/implicit_viscosity/cuda.h"

#include <cstring>

#include "sim/cuda/state.h"

namespace slosh::cuda {

void ViscousSolver::plan(const Plan& plan, const ParticleStart& start, std::size_t body_count,
                         const WrenchSums& sums, CallCheck& check) {
  if (!plan.implicit_viscosity) return;
  sums_ = &sums;
  check.ok(cudaEventCreateWithFlags(&ready_, cudaEventDisableTiming), "cudaEventCreate");
  if (check.failed()) return;
  check.ok(most_solve_blocks(blocks_), "looking how many blocks implicit viscosity may have");
  view_.fluid = static_cast<std::uint32_t>(start.particles.kind.size());
  view_.surface = static_cast<std::uint32_t>(start.moving.size());
  view_.rows.room = row_room(plan);
  view_.bodies = view_.surface ? static_cast<std::uint32_t>(body_count) : 0;
  placed_ = ranges_of(start.moving, body_count);
  drag_of_.assign(body_count, -1);
  for (std::size_t i = 0; i < sums.bodies().size(); ++i)
    drag_of_[sums.bodies()[i]] = static_cast<std::int32_t>(i);
  allocate_vectors(check);
  bodies_.allocate(view_.bodies, check);
  sent_.allocate(view_.bodies, check);
  unknowns_.allocate(view_.bodies, check);
  fixed_at_ = body_count * sizeof(Wrench);
  drags_at_ = fixed_at_ + sums.bodies().size() * sizeof(DeviceWrench);
  outcome_at_ = drags_at_ + sums.bodies().size() * sizeof(BodyDrag);
  back_.allocate(outcome_at_ + sizeof(ViscousOutcome), check);
  got_.allocate(back_.size(), check);
  view_.body = bodies_.data();
  view_.unknown = unknowns_.data();
  view_.wrenches = found_wrenches();
  view_.drags = found_drags();
  view_.outcome = outcome();
}

void ViscousSolver::allocate_vectors(CallCheck& check) {
  const std::size_t fluid = view_.fluid, entries = fluid + view_.surface;
  pairs_.allocate(PairRows::places(entries, view_.rows.room), check);
  counts_.allocate(entries, check);
  for (DeviceBuffer<float4>* buffer : {&change_, &residual_, &product_, &walls_a_, &block_a_})
    buffer->allocate(fluid, check);
  for (DeviceBuffer<float2>* buffer : {&walls_b_, &block_b_}) buffer->allocate(fluid, check);
  direction_.allocate(entries, check);
  on_surface_.allocate(view_.surface, check);
  const std::size_t groups = (entries + kSolveThreads - 1) / kSolveThreads;
  parts_.allocate(5 * groups + 2 * view_.bodies, check);
  view_.rows.pairs = pairs_.data();
  view_.rows.counts = counts_.data();
  view_.by_walls = {walls_a_.data(), walls_b_.data()};
  view_.block = {block_a_.data(), block_b_.data()};
  view_.change = change_.data();
  view_.residual = residual_.data();
  view_.product = product_.data();
  view_.direction = direction_.data();
  view_.on_surface = on_surface_.data();
  double* at = parts_.data();
  for (double** part : {&view_.parts.mass, &view_.parts.step, &view_.parts.curvature, &view_.parts.left,
                        &view_.parts.changed}) {
    *part = at;
    at += groups;
  }
  view_.parts.body_step = at;
  view_.parts.body_curvature = at + view_.bodies;
}

void ViscousSolver::write_rows(const SolveSides& sides, float dt, CallCheck& check, cudaStream_t stream) {
  if (check.failed()) return;
  launch_viscous_rows(sides.constants, sides.plan, sides.kinds.data(), sides.first_viscosity, dt, sides.fluid,
                      sides.fixed.sorted(), sides.moving.sorted(), sides.moving.local(), view_, stream);
  check.launched("viscous pairs");
  sums_->sum({sides.fixed, sides.moving}, sides.bodies, nullptr, found_drags(), check, stream);
}

// The copy before has been made: solve() waits where there are bodies to send.
void ViscousSolver::send(std::span<const ViscousBody> bodies, std::span<const RigidBody> before,
                         CallCheck& check, cudaStream_t stream) {
  if (view_.bodies == 0 || check.failed()) return;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    sent_[b] = {bodies[b], before[b].position, placed_[b].begin, placed_[b].end, drag_of_[b]};
  check.ok(cudaMemcpyAsync(bodies_.data(), sent_.data(), bodies_.bytes(), cudaMemcpyHostToDevice, stream),
           "sending bodies for implicit viscosity");
}

void ViscousSolver::solve(const SolveSides& sides, float dt, std::span<const ViscousBody> bodies,
                          std::span<const RigidBody> before, std::uint32_t* status,
                          std::span<Wrench> wrenches, CallCheck& check, cudaStream_t stream) {
  send(bodies, before, check, stream);
  if (check.failed()) return;
  check.ok(launch_viscous_solve(sides.constants, sides.plan, sides.kinds.data(), sides.first_viscosity, dt,
                                sides.fluid, sides.moving.sorted(), sides.moving.local(), view_, blocks_,
                                status, stream),
           "implicit viscosity");
  if (sums_->bodies().empty()) return;
  if (sums_->fixed_measured()) {
    launch_drag_on_fixed(sides.constants, sides.plan, sides.first_viscosity, sides.fluid,
                         sides.fixed.sorted(), sums_->wanted(), sides.fixed.local(), view_, stream);
    check.launched("drag on fixed bodies");
    sums_->sum({sides.fixed, sides.moving}, sides.bodies, fixed_wrenches(), nullptr, check, stream);
  }
  if (check.failed()) return;
  check.ok(cudaMemcpyAsync(got_.data(), back_.data(), back_.bytes(), cudaMemcpyDeviceToHost, stream),
           "fetching implicit viscosity");
  check.ok(cudaEventRecord(ready_, stream), "cudaEventRecord");
  check.ok(cudaEventSynchronize(ready_), "waiting for implicit viscosity");
  if (check.failed()) return;
  moved_.assign(bodies.size(), 0);
  for (std::size_t b = 0; b < bodies.size(); ++b) moved_[b] = view_.bodies > 0 && bodies[b].moves;
  read(before, wrenches);
}

void ViscousSolver::read(std::span<const RigidBody> before, std::span<Wrench> wrenches) {
  for (std::size_t b = 0; b < moved_.size(); ++b) {
    if (moved_[b]) wrenches[b] = wrenches[b] + read_at<Wrench>(got_, 0, b);
  }
  for (std::size_t i = 0; i < sums_->bodies().size(); ++i) {
    const std::uint32_t b = sums_->bodies()[i];
    if (!before[b].is_fixed()) continue;
    wrenches[b] = wrenches[b] + read_at<DeviceWrench>(got_, fixed_at_, i).wrench();
  }
}

void ViscousSolver::drags(std::span<BodyDrag> out) const {
  for (std::size_t i = 0; i < sums_->bodies().size(); ++i) {
    const std::uint32_t b = sums_->bodies()[i];
    if (b < moved_.size() && moved_[b]) out[b] = read_at<BodyDrag>(got_, drags_at_, i);
  }
}

}  // namespace slosh::cuda

namespace slosh::passes {

void implicit_viscosity_on_cuda(cuda::CudaState& s, const PassInputs& in) {
  s.viscous.solve(s.solve_sides(), static_cast<float>(in.dt), in.bodies, s.prepared, s.report.status(),
                  in.wrenches, s.check, s.stream);
}

}  // namespace slosh::passes
