#include "sim/passes/pass.h"

#include "sim/math/format.h"

namespace slosh::passes {

extern const PassEntry walls_pass;
constinit const PassEntry walls_pass{
    .words = "body particles on fluid",
    .reads = "positions, velocities, pressure, viscosity; boundary particles",
    .writes = "force on fluid (Eq 5, 9)",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (!f.fluid) return left_out("no fluid");
      if (f.solids == 0) return left_out("no body with a surface");
      return needed(format("Eq 5%s against the particles of %zu bodies", f.viscous ? " and 9" : "",
                           f.scene.bodies.size()));
    },
};

}  // namespace slosh::passes
