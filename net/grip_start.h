// Where a grip is before anybody holds it: the host's stand and a peer's device begin there.
#pragma once

#include "scenes/scene.h"

namespace slosh {

/// World pose of grip `grip` (below scene.grips.size()): on its body as the scene has it.
inline Pose grip_start(const Scene& scene, std::size_t grip) {
  const Grip& g = scene.grips[grip];
  return compose(scene.bodies[static_cast<std::size_t>(g.body)].pose, g.pose);
}

}  // namespace slosh
