#include "sim/cpu/state.h"

#include <algorithm>

namespace slosh {

CpuState::CpuState(const RunConstants& constants, const ParticleStart& start,
                   std::span<const RigidBody> bodies_in, int threads)
    : team(threads),
      fixed(start.fixed),
      moving(start.moving),
      probes(start.probes),
      fluid_count(start.fluid_count),
      wanted(bodies_in.size()),
      fields(start.clamp_fields),
      impulses(no_impulses(bodies_in.size())),
      taken(bodies_in.size()),
      bodies(bodies_in.begin(), bodies_in.end()),
      found(bodies_in.size()),
      drags(bodies_in.size()) {
  static_cast<RunConstants&>(context) = constants;
  for (const int b : constants.plan.wrench_bodies) wanted[static_cast<std::size_t>(b)] = 1;
  fixed_measured = std::any_of(constants.plan.wrench_bodies.begin(), constants.plan.wrench_bodies.end(),
                               [&](int b) { return bodies[static_cast<std::size_t>(b)].is_fixed(); });
  fluid.provide(context.plan, start.particles.kind.size());
  scratch.provide(context.plan, start.particles.kind.size());
  if (context.plan.has(PassId::kBonds)) bonds.table.resize(start.particles.kind.size());
  for (const DistanceField& field : fields) clamp_solids.push_back(clamp_solid(field, field.view()));
}

void CpuState::reshape(const ReshapedBody& as) {
  moving.replace(as.first, as.particles);
  const std::size_t at = kImpulseWords * as.body;
  recentre(std::span(impulses).subspan(at, kImpulseWords), as.recentred, context.impulse_units);
  if (!context.plan.clamps_penetration()) return;
  fields[as.body] = *as.clamp;
  clamp_solids[as.body] = clamp_solid(fields[as.body], fields[as.body].view());
}

void CpuState::sum_wrenches(const BodySurface& surface, std::span<Wrench> wrenches,
                            std::span<BodyDrag> of_drag) {
  centers.clear();
  for (const RigidBody& body : bodies) centers.push_back(body.position);
  sum_body_wrenches(context, team, fluid, surface.sorted(), centers, wanted,
                    memory<SurfaceSums>(PassId::kWrenches), wrenches, of_drag);
}

void CpuState::carry_probes_in() {
  if (probes.empty()) return;
  for (std::size_t p = 0; p < fluid.active; ++p) {
    if (fluid.id[p] < fluid_count) continue;
    const RigidBody& body = bodies[static_cast<std::size_t>(probes[fluid.id[p] - fluid_count].body)];
    fluid.x[p] = static_cast<float>(body.position.x);
    fluid.y[p] = static_cast<float>(body.position.y);
    fluid.z[p] = static_cast<float>(body.position.z);
    fluid.vx[p] = static_cast<float>(body.velocity.x);
    fluid.vy[p] = static_cast<float>(body.velocity.y);
    fluid.vz[p] = static_cast<float>(body.velocity.z);
    // A probe that a hand takes out of the domain comes back with it: it waits in the nearest cell.
    fluid.key[p] = context.grid.cell_of(fluid.x[p], fluid.y[p], fluid.z[p]);
  }
}

void CpuState::carry_probe_forces_out(std::span<Wrench> out) const {
  if (probes.empty()) return;
  for (std::size_t p = 0; p < fluid.active; ++p) {
    if (fluid.id[p] < fluid_count) continue;
    out[static_cast<std::size_t>(probes[fluid.id[p] - fluid_count].body)].force +=
        glm::dvec3(fluid.fx[p], fluid.fy[p], fluid.fz[p]);
  }
}

}  // namespace slosh
