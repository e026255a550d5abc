// A world made again from its scene and a saved state.
#pragma once

#include "host/tap.h"
#include "scenes/scene.h"
#include "sim/math/result.h"
#include "sim/world.h"

namespace slosh::keep {

struct RebuiltWorld {
  SampledScene sampled;
  World world;
};

/// Samples the scene, plans, makes the world and restores the state. Errors: any of these.
Result<RebuiltWorld> rebuild_world(const Scene& scene, double spacing, std::span<const std::uint8_t> state,
                                   const WorldOptions& options);

/// The same of a scene that is sampled already, at the spacing that it has.
Result<RebuiltWorld> rebuild_world(const Scene& scene, SampledScene sampled,
                                   std::span<const std::uint8_t> state, const WorldOptions& options);

/// Back to `start` with the live parameters as they are: what a host's reset does, and a replay's. Error: the
/// state does not fit.
Result<bool> reset_world(World& world, std::size_t fluids, std::span<const std::uint8_t> start);

}  // namespace slosh::keep
