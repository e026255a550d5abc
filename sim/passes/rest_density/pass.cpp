#include "sim/passes/pass.h"

#include "sim/passes/rest_density/rest_density.h"
#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry rest_density_pass;
constinit const PassEntry rest_density_pass{
    .words = "rest-density calibration",
    .reads = "time since the fluid was filled in",
    .writes = "what the corrected models press by",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.fluid ? needed("particle volume from rest density relaxes to that of a packing at rest")
                     : left_out("no fluid");
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          if (w.packed) return;
          if (corrects_gradients(w.plan().model))
            w.engine->set_correction(settled(w.constants.correction, w.constants.load_compression, w.age));
          w.packed = w.age >= kSettlingTime;
          if (!w.packed) w.age += step.dt;
        },
};

}  // namespace slosh::passes
