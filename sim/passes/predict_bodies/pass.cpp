#include "sim/passes/pass.h"

#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry predict_bodies_pass;
constinit const PassEntry predict_bodies_pass{
    .words = "predict bodies",
    .reads = "wrenches, handles, the last impulses of contacts and joints",
    .writes = "each free body's 6×6 system, for a solve together with the fluid",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.implicit || f.plan.model == ParticleModel::kIncompressible
                 ? (f.fluid ? needed("fluid and free bodies are solved together") : left_out("no fluid"))
                 : left_out("nothing is solved together with the fluid");
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          w.bodies.predict(w.plan(), w.body_forces(step), step, w.viscous_bodies);
        },
};

}  // namespace slosh::passes
