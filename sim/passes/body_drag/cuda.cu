// The change of the viscous force on the fluid when bodies end a step with another velocity than they began
// it with.
#include "sim/cuda/pair_rows.cuh"

namespace slosh::cuda {

namespace {

__global__ void set_velocities_kernel(SortedSurface surface, const DeviceBody* twists) {
  wait_for_last_kernel();
  const std::uint32_t i = thread_index();
  if (i >= surface.count) return;
  const float4 x = surface.x[i];
  const glm::vec3 v = twists[surface.body[i]].motion.velocity_at({x.x, x.y, x.z});
  surface.v[i] = make_float4(v.x, v.y, v.z, surface.v[i].w);
}

template <class Team, class Parts>
__global__ __launch_bounds__(kThreads) void drag_kernel(StepConstants c, const ParticleKind* kinds,
                                                        SortedFluid fluid, SortedSurface moving) {
  wait_for_last_kernel();
  const std::uint32_t p = Team::particle();
  if (p >= fluid.count) return;
  const std::uint32_t cell = fluid.state.key[p];
  if (cell >= c.grid.retired_key()) return;
  float4 force = fluid.force[p];
  if (force.w == 0.0f) return;  // no body is near
  const ParticleView<float> self =
      view(fluid.state.x[p], fluid.state.v[p], particle_viscosity(fluid, kinds, p));
  ForceSum<float> sum{0.0f, 0.0f, 0.0f};
  for_each_dragging<Team>(c, self, columns(moving), moving.cells, cell,
                          [&](const ParticleView<float>& i, float reach) {
                            add_pair_viscosity<typename Parts::ForceKernel, Parts::kDrag>(
                                self, i, reach, c.drag_shape, 1.0f, sum);
                          });
  Team::sum(sum.x, sum.y, sum.z);
  if (Team::lane() != 0) return;
  force.x += c.force_scale * sum.x;
  force.y += c.force_scale * sum.y;
  force.z += c.force_scale * sum.z;
  fluid.force[p] = force;
}

}  // namespace

void launch_drag(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                 const SortedFluid& fluid, const SortedSurface& moving, const DeviceBody* twists,
                 cudaStream_t stream) {
  if (moving.count == 0) return;
  launch_early(set_velocities_kernel, blocks_for(moving.count), kThreads, stream, moving, twists);
  with_model(plan.model, [&]<class Parts>() {
    with_team<kTensorTeams>(fluid.count, [&]<class Team>() {
      const auto kernel = drag_kernel<Team, Parts>;
      launch_early(kernel, blocks_for(fluid.count * Team::kLanes), kThreads, stream, constants, kinds, fluid,
                   moving);
    });
  });
}

}  // namespace slosh::cuda
