// Leap-frog for fluid particles.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "sim/cpu/passes.h"
#include "sim/cpu/state.h"
#include "sim/passes/integrate_fluid/leap_frog.h"
#include "sim/snapshot.h"
#include "sim/walls/penetration_clamp.h"

namespace slosh {

namespace {
constexpr std::size_t kParticlesPerChunk = 2048;

// Several walls may bend a way one after the other; the integers add up to the same whoever comes first.
// True when it would have been past the wall's own particles, which sit twice as deep as it may get.
bool keep_from_walls(const WallClamps& clamps, const ImpulseUnits& units, float mass, bool near,
                     const glm::vec3& from, glm::vec3& x, glm::vec3& v) {
  const auto add = [&](std::size_t word, std::int64_t value) {
    std::atomic_ref(clamps.impulses[word]).fetch_add(value, std::memory_order_relaxed);
  };
  bool past = false;
  const bool bent = clamp_against_all(
      [&](std::uint32_t b) { return clamps.solids.spheres[b]; },
      [&](std::uint32_t b) -> const ClampBody& { return clamps.solids.bodies[b]; },
      static_cast<std::uint32_t>(clamps.solids.bodies.size()), near, from, x, v,
      [&](std::uint32_t b, const glm::vec3& to, const glm::vec3& before) {
        past |= glm::distance(to, x) > clamps.solids.bodies[b].depth;
        const std::size_t number = clamps.solids.numbers[b];
        impulse_on_body({mass, to, x, before, v}, clamps.centers[number], units,
                        [&](int word, std::int64_t value) {
                          add(kImpulseWords * number + static_cast<std::size_t>(word), value);
                        });
      });
  if (bent) add(clamps.impulses.size() - 1, 1);
  return past;
}
}  // namespace

void integrate_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid, const WallClamps& clamps,
                     double time_step) {
  const float dt = static_cast<float>(time_step);
  const float max_speed = static_cast<float>(speed_limit(context.plan, time_step));
  const std::vector<ClampBody>& bodies = clamps.solids.bodies;
  const bool any_fast =
      std::any_of(bodies.begin(), bodies.end(), [](const ClampBody& body) { return body.fast; });
  const bool clamped = !bodies.empty();
  team.run(fluid.active, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    std::uint32_t status = 0;
    for (std::size_t p = begin; p < end; ++p) {
      const ParticleKind& kind = context.kinds[fluid.kind[p]];
      if (kind.probe) continue;  // its body moves it
      const float per_mass = dt / kind.mass;
      glm::vec3 x(fluid.x[p], fluid.y[p], fluid.z[p]);
      const glm::vec3 from = x;
      glm::vec3 v(fluid.vx[p], fluid.vy[p], fluid.vz[p]);
      if (advance_particle({fluid.fx[p], fluid.fy[p], fluid.fz[p]}, per_mass, context.gravity, dt, max_speed,
                           x, v)) {
        status |= kStatusSpeedLimited;
      }
      if (clamped && (any_fast || fluid.near_wall[p]) && context.grid.contains(x.x, x.y, x.z) &&
          keep_from_walls(clamps, context.impulse_units, kind.mass, fluid.near_wall[p], from, x, v)) {
        status |= kStatusClamped;
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
        if (!finite) context.broken.fetch_add(1, std::memory_order_relaxed);
      }
    }
    if (status) context.status.fetch_or(status, std::memory_order_relaxed);
  });
}

namespace passes {

void integrate_fluid_on_cpu(CpuState& s, const PassInputs& in) {
  ClampBodies& clamped = s.memory<ClampBodies>(PassId::kIntegrateFluid);
  s.centers.clear();
  for (const RigidBody& body : in.after) s.centers.push_back(body.position);
  if (s.context.plan.clamps_penetration())
    place_clamp_bodies(s.clamp_solids, s.context.plan, s.bodies, in.after, clamped);
  integrate_fluid(s.context, s.team, s.fluid, {clamped, s.centers, s.impulses}, in.dt);
}

}  // namespace passes

}  // namespace slosh
