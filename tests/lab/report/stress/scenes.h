// Scenes of stress cases that tests put to other uses too.
#pragma once

#include "scenes/scene.h"

namespace slosh::report {

/// m, where the held box begins.
inline const glm::dvec3 kHeldBox(0.0, 0.06, 0.0);

/// A box of 4 cm (body 1) held half in the fluid of a small tank, by `grips` equal couplings on a circle of
/// 3 cm around it. kg, N/m, N·s/m.
Scene held_box(double mass, double stiffness, double damping, int grips);

/// A lid (body 1) that fits a tank of 12 x 12 cm, 20 cm high, held stiffly a centimetre over 7 cm of fluid.
Scene press_scene();

}  // namespace slosh::report
