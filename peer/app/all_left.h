// A run that has nothing left to run with.
#pragma once

#include <optional>

#include "scenes/scene.h"
#include "sim/world.h"

namespace slosh {

/// What is wrong where all fluid left the domain before the run began.
inline Error all_left_while_settling(const Scene& scene) {
  return {scene.source_file.empty() ? scene.name : scene.source_file,
          "all of its fluid left the domain while the world settled: there is nothing to feel",
          "Put the fluid into a vessel, or give the scene settle_s = 0 where it is meant to fall"};
}

/// The same of a world that has settled; nothing where fluid is left, or was never there.
inline std::optional<Error> all_left(const World& world, const Scene& scene) {
  if (world.fluid_count() == 0 || world.diagnostics().retired < world.fluid_count()) return std::nullopt;
  return all_left_while_settling(scene);
}

}  // namespace slosh
