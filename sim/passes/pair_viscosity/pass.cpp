#include "sim/passes/pass.h"

#include "sim/math/format.h"

namespace slosh::passes {

extern const PassEntry pair_viscosity_pass;
constinit const PassEntry pair_viscosity_pass{
    .words = "viscous force, a viscosity a particle",
    .reads = "positions, velocities, volume, viscosity",
    .writes = "force on fluid (Eq 9)",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.viscous && !f.one)
        return needed(format("Eq 9 between fluids of %.3g to %.3g Pa·s", f.fluids.least_viscous,
                             f.fluids.most_viscous));
      return left_out(f.viscous ? "one viscosity: Eq 6 is enough" : "nothing is viscous");
    },
};

}  // namespace slosh::passes
