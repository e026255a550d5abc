// Leap-frog for fluid particles.
#include <cmath>

#include "sim/cpu/passes.h"
#include "sim/leap_frog.h"
#include "sim/snapshot.h"

namespace slosh {

namespace {
constexpr std::size_t kParticlesPerChunk = 2048;
}

void integrate_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid, double time_step) {
  const float dt = static_cast<float>(time_step);
  const float max_speed = static_cast<float>(speed_limit(context.plan, time_step));
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

}  // namespace slosh
