#include "sim/passes/pass.h"

#include "sim/math/format.h"
#include "sim/world_parts.h"

namespace slosh::passes {

extern const PassEntry move_bodies_pass;
constinit const PassEntry move_bodies_pass{
    .words = "move bodies",
    .reads = "velocities",
    .writes = "poses, angular momentum",
    .need = [](const SceneFacts& f) -> PassNeed {
      if (f.driven > 0)
        return needed(
            format("leap-frog for %d free bodies, and %d go by their keys", f.free_bodies, f.driven));
      return f.free_bodies > 0 ? needed(format("leap-frog for %d free bodies", f.free_bodies))
                               : left_out("every body is fixed");
    },
    .run =
        [](World::Impl& w, const SubStep& step) {
          w.bodies.move(step);
          w.status |= w.bodies.part_with_lost(w.gravity());
        },
};

}  // namespace slosh::passes
