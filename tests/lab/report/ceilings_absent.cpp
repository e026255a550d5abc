// Where the CUDA backend is left out.
#include "tests/lab/report/ceilings.h"

namespace slosh::report {

Result<Ceilings> cuda_ceilings() {
  return Error{"the GPU's ceilings", "this was built without CUDA", "Measure on the CPU: --backend cpu"};
}

}  // namespace slosh::report
