#include "sim/passes/pass.h"

#include "sim/math/format.h"
#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry solve_bodies_pass;
constinit const PassEntry solve_bodies_pass{
    .words = "solve bodies",
    .reads = "wrenches, drag rates, gravity",
    .writes = "velocity of each free body (Eq 13), with its couplings, joints and contacts",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.free_bodies > 0 || !f.scene.grips.empty())
        return needed(format("Eq 13 for %d free bodies, with their couplings%s and contacts", f.free_bodies,
                             f.scene.joints.empty() ? "" : ", joints"));
      return left_out(f.driven > 0 ? "no body is free" : "every body is fixed");
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          w.status |= w.bodies.solve(w.plan(), w.body_forces(step), step);
          if (!w.plan().has(PassId::kBodyDrag)) return;
          for (std::size_t b = 0; b < w.found.size(); ++b)
            w.found[b] = w.found[b] + drag_of(w.drag_matrices[b], w.bodies.changes()[b]);
        },
};

}  // namespace slosh::passes
