#include "sim/passes/pass.h"

namespace slosh::passes {

extern const PassEntry body_drag_pass;
constinit const PassEntry body_drag_pass{
    .words = "implicit drag on free bodies",
    .reads = "the bodies' solved velocities",
    .writes = "viscous force on the fluid by them",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.viscous && f.free_solids > 0 && f.plan.waits_for_bodies && !f.implicit)
        return needed(
            "free bodies in viscous fluid: drag implicit in the body's velocity, as part of the bodies' "
            "solve");
      return left_out(!f.viscous           ? "nothing is viscous"
                      : f.implicit         ? "bodies are part of the implicit viscosity solve"
                      : f.free_solids == 0 ? "no free body with a surface meets fluid"
                                           : "a probe needs explicit viscosity");
    },
};

}  // namespace slosh::passes
