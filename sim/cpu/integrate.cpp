// Leap-frog for fluid particles, and putting particles in order for the next step.
#include <algorithm>
#include <cmath>

#include "sim/cpu/passes.h"
#include "sim/snapshot.h"

namespace slosh {

namespace {
constexpr std::size_t kParticlesPerChunk = 2048;
}

void integrate_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid) {
  const float dt = static_cast<float>(context.plan.time_step);
  const float max_speed = static_cast<float>(context.plan.max_speed);
  team.run(fluid.active, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t status = 0;
    for (std::size_t p = begin; p < end; ++p) {
      const ParticleKind& kind = context.kinds[fluid.kind[p]];
      if (kind.probe) continue;  // its body moves it
      const float per_mass = dt / kind.mass;
      glm::vec3 x(fluid.x[p], fluid.y[p], fluid.z[p]);
      glm::vec3 v(fluid.vx[p], fluid.vy[p], fluid.vz[p]);
      if (advance_particle({fluid.fx[p], fluid.fy[p], fluid.fz[p]}, per_mass, context.gravity, dt, max_speed,
                           x, v)) {
        status |= kStatusSpeedLimited;
      }
      fluid.vx[p] = v.x;
      fluid.vy[p] = v.y;
      fluid.vz[p] = v.z;
      fluid.x[p] = x.x;
      fluid.y[p] = x.y;
      fluid.z[p] = x.z;
      if (context.grid.contains(fluid.x[p], fluid.y[p], fluid.z[p])) {
        fluid.key[p] = context.grid.cell_of(fluid.x[p], fluid.y[p], fluid.z[p]);
      } else {
        fluid.key[p] = context.grid.retired_key();
        const bool finite =
            std::isfinite(fluid.x[p]) && std::isfinite(fluid.y[p]) && std::isfinite(fluid.z[p]);
        status |= finite ? kStatusEscaped : kStatusNonFinite;
      }
    }
    if (status) context.status.fetch_or(status, std::memory_order_relaxed);
  });
}

void sort_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid, KeySorter& sorter,
                FluidParticles& scratch) {
  sorter.sort(fluid.key.data(), fluid.active, context.grid.retired_key());
  const std::uint32_t* order = sorter.order();
  team.run(fluid.active, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    const auto gather = [&](const auto& from, auto& to) {
      for (std::size_t p = begin; p < end; ++p) to[p] = from[order[p]];
    };
    gather(fluid.x, scratch.x);
    gather(fluid.y, scratch.y);
    gather(fluid.z, scratch.z);
    gather(fluid.vx, scratch.vx);
    gather(fluid.vy, scratch.vy);
    gather(fluid.vz, scratch.vz);
    gather(fluid.volume, scratch.volume);
    gather(fluid.id, scratch.id);
    gather(fluid.kind, scratch.kind);
  });
  fluid.x.swap(scratch.x);
  fluid.y.swap(scratch.y);
  fluid.z.swap(scratch.z);
  fluid.vx.swap(scratch.vx);
  fluid.vy.swap(scratch.vy);
  fluid.vz.swap(scratch.vz);
  fluid.volume.swap(scratch.volume);
  fluid.id.swap(scratch.id);
  fluid.kind.swap(scratch.kind);
  fluid.index.rebuild(context.grid, fluid.key.data(), fluid.active);
  fluid.active = fluid.index.particles();
  // The last row's batch reads on into what was retired, and zero times not-a-number is not zero.
  for (Column<float>* column : {&fluid.x, &fluid.y, &fluid.z, &fluid.vx, &fluid.vy, &fluid.vz,
                                &fluid.pressure, &fluid.volume, &fluid.viscosity}) {
    std::fill_n(column->begin() + static_cast<std::ptrdiff_t>(fluid.active), kLanes, 0.0f);
  }
}

}  // namespace slosh
