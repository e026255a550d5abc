#include "sim/passes/pass.h"

namespace slosh::passes {

extern const PassEntry density_pass;
constinit const PassEntry density_pass{
    .words = "density",
    .reads = "positions",
    .writes = "pressure (Eq 2, 7), volume; rows of pairs",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.fluid ? needed(f.plan.model == ParticleModel::kPaper
                                  ? "Eq 2 and 7, fluid particles only (section 4.1)"
                                  : "Eq 2 and 7, body particles counted")
                     : left_out("no fluid");
    },
};

}  // namespace slosh::passes
