#include "peer/install/version.h"

#include "commit.h"  // written by each build (commit.cmake)
#include "sim/backend.h"

namespace slosh {

std::string version_text() {
  std::string text =
      "slosh " SLOSH_VERSION "\ncommit " SLOSH_COMMIT "\nbuilt with " SLOSH_COMPILER ", for " SLOSH_ARCH;
  text += "\nbackends CPU";
  if constexpr (sizeof(SLOSH_CUDA_VERSION) > 1) text += ", CUDA " SLOSH_CUDA_VERSION;
  const CudaDevice gpu = find_cuda_device();
  text += gpu.available ? " on " + gpu.name : "; " + gpu.reason;
  return text + "\nlibraries " SLOSH_LIBRARIES;
}

}  // namespace slosh
