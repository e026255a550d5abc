// Where fluid is seen in a picture of all particles and in one of the shell alone.
#pragma once

#include <vector>

#include "net/codec/snapshot_codec.h"
#include "sim/math/result.h"

namespace slosh::bench {

struct MaskDifference {
  double mean = 0.0;   ///< pixels that are fluid in one picture alone, % of those that are in the full one
  double worst = 0.0;  ///< of the frames compared
};

/// Draws every tenth pair of pictures at 640 × 480 without a display. Errors: no OpenGL 4.5 through EGL.
Result<MaskDifference> compare_masks(const std::vector<DecodedFrame>& all,
                                     const std::vector<DecodedFrame>& shell, double spacing);

}  // namespace slosh::bench
