#include "sim/passes/pass.h"

namespace slosh::passes {

extern const PassEntry contacts_pass;
constinit const PassEntry contacts_pass{
    .words = "contacts",
    .reads = "body states, distance fields, the last impulses",
    .writes = "part of the bodies' solve",
    .need = [](const SceneFacts& f) -> PassNeed {
      const int free_probes = f.free_bodies - f.free_solids;
      if ((f.free_solids > 0 && f.solids > 1) || (free_probes > 0 && f.solids > 0))
        return needed("a free body can touch another body");
      return left_out(f.free_bodies > 0 ? "no other body with a surface" : "no free body");
    },
};

}  // namespace slosh::passes
