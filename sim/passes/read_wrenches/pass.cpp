#include "sim/passes/pass.h"

#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry read_wrenches_pass;
constinit const PassEntry read_wrenches_pass{
    .words = "wrenches to the host",
    .reads = "the engine's sums",
    .writes = "the bodies' wrenches and drag rates: a GPU is waited for here",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.fluid ? needed("bodies are solved on the processor") : left_out("no fluid");
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          w.engine->wrenches(w.found);
          if (step.part != TakePart::kFluid && w.plan().has(PassId::kBodyDrag)) w.take_drags();
        },
};

}  // namespace slosh::passes
