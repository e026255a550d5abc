#include "host/keep/rebuild.h"

#include "scenes/sample.h"
#include "sim/plan.h"

namespace slosh::keep {

Result<RebuiltWorld> rebuild_world(const Scene& scene, double spacing, std::span<const std::uint8_t> state,
                                   const WorldOptions& options) {
  Result<SampledScene> sampled = sample_scene(scene, spacing);
  if (!sampled) return sampled.error();
  return rebuild_world(scene, std::move(sampled.value()), state, options);
}

Result<RebuiltWorld> rebuild_world(const Scene& scene, SampledScene sampled, std::span<const std::uint8_t> state,
                                   const WorldOptions& options) {
  Result<World> world = make_world(scene, sampled, make_plan(scene, sampled.spacing), options);
  if (!world) return world.error();
  const Result<bool> restored = world.value().restore(state);
  if (!restored) return restored.error();
  return RebuiltWorld{std::move(sampled), std::move(world.value())};
}

Result<bool> reset_world(World& world, std::size_t fluids, std::span<const std::uint8_t> start) {
  std::vector<double> viscosities;
  for (std::size_t i = 0; i < fluids; ++i) viscosities.push_back(world.viscosity(i));
  const double gravity_scale = world.gravity_scale();
  const Result<bool> restored = world.restore(start);
  if (!restored) return restored;
  for (std::size_t i = 0; i < fluids; ++i) {
    // What held before holds now: these were let through once.
    if (viscosities[i] != world.viscosity(i)) (void)world.set_viscosity(i, viscosities[i]);
  }
  if (gravity_scale != world.gravity_scale()) (void)world.set_gravity_scale(gravity_scale);
  return true;
}

}  // namespace slosh::keep
