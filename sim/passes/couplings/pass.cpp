#include "sim/passes/pass.h"

#include "sim/math/format.h"

namespace slosh::passes {

extern const PassEntry couplings_pass;
constinit const PassEntry couplings_pass{
    .words = "virtual couplings",
    .reads = "handles",
    .writes = "part of the bodies' solve (section 4.4)",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.scene.grips.empty()
                 ? left_out("no grip")
                 : needed(format("%zu grips, implicit, all of a body in one 6×6 solve (section 4.4)",
                                 f.scene.grips.size()));
    },
};

}  // namespace slosh::passes
