#include "sim/passes/pass.h"

#include "sim/math/format.h"

namespace slosh::passes {

extern const PassEntry fluid_stress_pass;
constinit const PassEntry fluid_stress_pass{
    .words = "viscous stress of particles",
    .reads = "positions, velocities, viscosity; no-slip walls",
    .writes = "each particle's stress, what is left for Eq 9",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.plan.passes_stress && f.viscous && !f.implicit)
        return needed(
            format("viscous stress τ = μ(G + Gᵀ) for fluid of up to %.3g Pa·s; Eq 9 within about two "
                   "spacings of no-slip walls",
                   f.fluids.most_viscous));
      return left_out(!f.viscous                          ? "nothing is viscous"
                      : !corrects_gradients(f.plan.model) ? "the corrected and the incompressible model's"
                      : f.implicit                        ? "implicit viscosity uses Eq 9"
                                   : "thin fluid: artificial viscosity exceeds its own");
    },
};

}  // namespace slosh::passes
