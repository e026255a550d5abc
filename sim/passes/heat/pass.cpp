#include "sim/passes/pass.h"

#include "sim/math/format.h"
#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry heat_pass;
constinit const PassEntry heat_pass{
    .words = "heat and setting",
    .reads = "positions, temperatures, how far each has set; bodies of a stated temperature",
    .writes = "temperature, how far each has set, the viscosity by both",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (!f.heat) return left_out(f.fluid ? "one temperature everywhere, and nothing sets" : "no fluid");
      return needed(format("%d step%s in one", f.plan.heat_steps, f.plan.heat_steps == 1 ? "" : "s"));
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          // The clock stands while a world settles; a step's first sub-step speaks for all of it.
          if (step.part != TakePart::kAll || !w.passes_heat_in(step)) return;
          SubStep all = step;
          all.dt = w.plan().heat_steps * w.plan().time_step;
          w.run_on_engine(PassId::kHeat, all);
        },
};

}  // namespace slosh::passes
