#include "sim/passes/pass.h"

#include "sim/math/format.h"

namespace slosh::passes {

extern const PassEntry joints_pass;
constinit const PassEntry joints_pass{
    .words = "joints",
    .reads = "body states, the last impulses",
    .writes = "part of the bodies' solve",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.scene.joints.empty()
                 ? left_out("no joint")
                 : needed(format("%zu joints, all of them in one solve", f.scene.joints.size()));
    },
};

}  // namespace slosh::passes
