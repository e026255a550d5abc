// `slosh host` from its options to its exit code.
#pragma once

#include "host/app/host_options.h"

namespace slosh {

int host_world(const HostVerbOptions& options);

}  // namespace slosh
