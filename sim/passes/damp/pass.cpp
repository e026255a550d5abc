#include "sim/passes/pass.h"

#include <cmath>

#include "sim/world_parts.h"

namespace slosh::passes {

// s: past critical for a hand-sized vessel's slosh, so it creeps to its level
static constexpr double kDampingTime = 0.05;

extern const PassEntry damp_pass;
constinit const PassEntry damp_pass{
    .words = "damping",
    .reads = "velocities",
    .writes = "velocities",
    .need = [](const SceneFacts& f) -> PassNeed {
      (void)f;
      return left_out("while a scene settles");
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          const double keep = std::exp(-step.dt / kDampingTime);
          w.engine->damp(static_cast<float>(keep));
          if (step.part != TakePart::kFluid) w.bodies.damp_held(keep);
        },
};

}  // namespace slosh::passes
