#include "host/keep/rebuild.h"

#include <optional>

#include "scenes/sample.h"
#include "sim/plan.h"

namespace slosh::keep {

Result<RebuiltWorld> rebuild_world(const Scene& scene, double spacing, std::span<const std::uint8_t> state,
                                   const WorldOptions& options) {
  Result<SampledScene> sampled = sample_scene(scene, spacing);
  if (!sampled) return sampled.error();
  return rebuild_world(scene, std::move(sampled.value()), state, options);
}

Result<RebuiltWorld> rebuild_world(const Scene& scene, SampledScene sampled,
                                   std::span<const std::uint8_t> state, const WorldOptions& options) {
  // What was saved by a GPU before it had implicit viscosity fits a plan without.
  std::optional<Error> refused;
  for (const bool may_be_implicit : {true, false}) {
    Result<World> world =
        make_world(scene, sampled, make_plan(scene, sampled.spacing, may_be_implicit), options);
    if (!world) return world.error();
    const Result<bool> restored = world.value().restore(state);
    if (restored) return RebuiltWorld{std::move(sampled), std::move(world.value())};
    if (!refused) refused = restored.error();
    if (!world.value().plan().implicit_viscosity) break;
  }
  return *refused;
}

Result<bool> reset_world(World& world, std::size_t fluids, std::span<const std::uint8_t> start) {
  std::vector<double> viscosities;
  for (std::size_t i = 0; i < fluids; ++i) viscosities.push_back(world.viscosity(i));
  const double gravity_scale = world.gravity_scale();
  const std::vector<double> stiffness(world.grip_stiffness().begin(), world.grip_stiffness().end());
  const Result<bool> restored = world.restore(start);
  if (!restored) return restored;
  for (std::size_t i = 0; i < fluids; ++i) {
    // What held before holds now: these were let through once.
    if (viscosities[i] != world.viscosity(i)) (void)world.set_viscosity(i, viscosities[i]);
  }
  if (gravity_scale != world.gravity_scale()) (void)world.set_gravity_scale(gravity_scale);
  for (std::size_t g = 0; g < stiffness.size(); ++g)
    if (stiffness[g] != world.grip_stiffness()[g]) (void)world.set_grip_stiffness(g, stiffness[g]);
  return true;
}

}  // namespace slosh::keep
