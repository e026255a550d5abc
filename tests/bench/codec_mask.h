// Where fluid is seen in a picture of all particles and in one of the shell alone.
#pragma once

#include <vector>

#include "net/codec/snapshot_codec.h"
#include "sim/math/result.h"

namespace slosh::bench {

/// Of each pair of pictures, draws both at 640 × 480 without a display: pixels that are fluid in one alone, %
/// of those that are in the full one. Errors: no OpenGL 4.5 through EGL.
Result<std::vector<double>> compare_masks(const std::vector<DecodedFrame>& all,
                                          const std::vector<DecodedFrame>& shell, double spacing);

}  // namespace slosh::bench
