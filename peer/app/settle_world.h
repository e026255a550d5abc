// How a world comes to rest before its run.
#pragma once

#include <span>

#include "peer/app/prepare.h"
#include "peer/app/time_estimate.h"

namespace slosh {

/// What is wrong where all fluid left the domain before the run began.
inline Error all_left_while_settling(const Scene& scene) {
  return {scene.source_file.empty() ? scene.name : scene.source_file,
          "all of its fluid left the domain while the world settled: there is nothing to feel",
          "Put the fluid into a vessel, or give the scene settle_s = 0 where it is meant to fall"};
}

/// Where the scene of `prepared` asks for it, lets `world` come to rest in `hands`, one a grip. `seconds`,
/// simulated, of the run that follows: what is going to take long is told, asked for or refused before
/// (agree_on_time). Errors: that, or no fluid is left where there was some.
inline Result<bool> settle_world(World& world, const Prepared& prepared, std::span<const HandleInput> hands,
                                 double seconds, Progress& progress) {
  const Scene& scene = prepared.scene;
  const Result<bool> agreed =
      agree_on_time(world, hands, {scene.settle, seconds, !prepared.unpaced, prepared.agreed}, progress);
  if (!agreed) return agreed;
  world.settle(scene.settle, hands, nullptr, scene.settle_longest);
  if (world.fluid_count() == 0 || world.diagnostics().retired < world.fluid_count()) return true;
  return all_left_while_settling(scene);
}

}  // namespace slosh
