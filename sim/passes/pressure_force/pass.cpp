#include "sim/passes/pass.h"

namespace slosh::passes {

extern const PassEntry pressure_force_pass;
constinit const PassEntry pressure_force_pass{
    .words = "pressure force",
    .reads = "positions, velocities, pressure, volume",
    .writes = "force on fluid (Eq 5)",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.fluid ? needed(f.plan.model == ParticleModel::kPaper ? "Eq 5"
                              : f.plan.model == ParticleModel::kIncompressible
                                  ? "Eq 5 by corrected gradients and the last step's pressures"
                                  : "Eq 5 by corrected gradients")
                     : left_out("no fluid");
    },
};

}  // namespace slosh::passes
