#include "sim/passes/pass.h"

#include "sim/math/format.h"

namespace slosh::passes {

extern const PassEntry one_viscosity_pass;
constinit const PassEntry one_viscosity_pass{
    .words = "viscous force, one viscosity",
    .reads = "positions, velocities, volume",
    .writes = "force on fluid (Eq 6)",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.viscous && f.one) return needed(format("Eq 6: every fluid has %.3g Pa·s", f.fluids.most_viscous));
      return left_out(f.viscous ? "fluids differ: Eq 9 takes its place" : "nothing is viscous");
    },
};

}  // namespace slosh::passes
