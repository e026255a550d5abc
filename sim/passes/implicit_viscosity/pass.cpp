#include "sim/passes/pass.h"

#include "sim/math/format.h"
#include "sim/viscosity/stability.h"
#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry implicit_viscosity_pass;
constinit const PassEntry implicit_viscosity_pass{
    .words = "implicit viscosity",
    .reads = "positions, volume, viscosity, velocities, forces; bodies' systems",
    .writes = "viscous force at the sub-step's end, on fluid and bodies",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.implicit)
        return needed(
            format("viscous force by the velocities at the step's end, one solve for all: explicit it "
                   "would need steps of %.3g ms",
                   1e3 * viscous_step(f.scene, f.plan, f.fluids)));
      return left_out(!f.viscous                          ? "nothing is viscous"
                      : !corrects_gradients(f.plan.model) ? "the corrected and the incompressible model's"
                      : f.probes > 0                      ? "a probe needs explicit viscosity"
                                                          : "explicit viscosity costs less here");
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          w.run_on_engine(PassId::kImplicitViscosity, step);
          w.take_drags();
        },
};

}  // namespace slosh::passes
