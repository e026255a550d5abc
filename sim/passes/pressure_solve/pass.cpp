#include "sim/passes/pass.h"

#include "sim/math/format.h"
#include "sim/passes/pressure_solve/limits.h"

namespace slosh::passes {

extern const PassEntry pressure_solve_pass;
constinit const PassEntry pressure_solve_pass{
    .words = "pressure projection",
    .reads = "the same, the last step's pressures",
    .writes = "pressures; their force on fluid and bodies",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (!f.fluid) return left_out("no fluid");
      if (f.plan.model != ParticleModel::kIncompressible)
        return left_out("Eq 7 gives the pressures: the incompressible model solves for them");
      return needed(
          format("in place of Eq 7: pressure projection, %d iterations at most", kMaxPressureIterations));
    },
};

}  // namespace slosh::passes
