#include "sim/passes/pass.h"

#include <algorithm>

#include "sim/math/format.h"
#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry bonds_pass;
constinit const PassEntry bonds_pass{
    .words = "bonds of what has set",
    .reads = "positions, how far each has set; who is bound to whom",
    .writes = "force on fluid; torn bonds",
    .need = [](const SceneFacts& f) -> PassNeed {
      double stiffest = 0.0;
      for (const Fluid& fluid : f.scene.fluids) stiffest = std::max(stiffest, fluid.heat.modulus);
      if (!f.heat || stiffest == 0.0) return left_out(f.fluid ? "nothing becomes elastic" : "no fluid");
      return needed(format("up to %.3g Pa", stiffest));
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          // What has set at the start is bound while the world settles, when no heat passes.
          const bool look = w.passes_heat_in(step) || (step.part != TakePart::kAll && step.elapsed == 0.0);
          w.engine->run(PassId::kBonds, {.dt = step.dt, .look = look});
        },
};

}  // namespace slosh::passes
