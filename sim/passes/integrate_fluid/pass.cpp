#include "sim/passes/pass.h"

#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry integrate_fluid_pass;
constinit const PassEntry integrate_fluid_pass{
    .words = "integrate fluid",
    .reads = "force; distance fields and ways of bodies",
    .writes = "velocity, position (leap-frog), key",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.fluid ? needed("leap-frog") : left_out("no fluid");
    },
    .run = [](World::Impl& w,
              const SubStep& step) { w.run_on_engine(PassId::kIntegrateFluid, step, w.bodies_after(step)); },
};

}  // namespace slosh::passes
