#include "sim/passes/pass.h"

namespace slosh::passes {

extern const PassEntry sort_fluid_pass;
constinit const PassEntry sort_fluid_pass{
    .words = "sort fluid",
    .reads = "keys",
    .writes = "every carried column in cell order; the table of cells",
    .need = [](const SceneFacts& f) -> PassNeed {
      return f.fluid ? needed("cells of the support radius, so that neighbour rows are contiguous")
                     : left_out("no fluid");
    },
};

}  // namespace slosh::passes
