#include "sim/passes/pass.h"

namespace slosh::passes {

extern const PassEntry body_drag_pass;
constinit const PassEntry body_drag_pass{
    .words = "implicit drag on free bodies",
    .reads = "the bodies' solved velocities",
    .writes = "viscous force on the fluid by them",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.viscous && f.plan.waits_for_bodies && !f.implicit)
        return needed(
            "free bodies in viscous fluid: drag by the velocity at the step's end, in the bodies' own solve");
      return left_out(!f.viscous                          ? "nothing is viscous"
                      : f.implicit                        ? "bodies are in the implicit solve"
                      : !f.plan.has(PassId::kPlaceBodies) ? "no free body with a surface meets fluid"
                                                          : "beside a probe drag stays explicit");
    },
};

}  // namespace slosh::passes
