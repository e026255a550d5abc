#include "sim/passes/pass.h"

#include "sim/math/format.h"

namespace slosh::passes {

extern const PassEntry wrenches_pass;
constinit const PassEntry wrenches_pass{
    .words = "wrench on bodies",
    .reads = "the same",
    .writes = "force and torque on bodies (Eq 10–12)",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (!f.plan.wrench_bodies.empty())
        return needed(
            format("Eq 10–12 for %zu bodies that are free or measured", f.plan.wrench_bodies.size()));
      return left_out(f.fluid ? "every body is fixed and none is measured" : "no fluid");
    },
};

}  // namespace slosh::passes
