#include "sim/passes/pass.h"

namespace slosh::passes {

extern const PassEntry place_bodies_pass;
constinit const PassEntry place_bodies_pass{
    .words = "place body particles",
    .reads = "body states",
    .writes = "boundary particles' positions, velocities (Eq 14)",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.fluid && f.driven > 0) return needed("free and driven bodies carry their particles (Eq 14)");
      return f.fluid && f.free_solids > 0 ? needed("free bodies carry their particles (Eq 14)")
                                          : left_out("no free body with a surface meets fluid");
    },
};

}  // namespace slosh::passes
