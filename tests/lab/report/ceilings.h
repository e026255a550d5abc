// What a machine does at best: the ceilings of a roofline.
#pragma once

#include <cstddef>

#include "sim/math/result.h"

namespace slosh::report {

/// What a machine does at best, measured.
struct Ceilings {
  double bytes_per_s = 0.0;  ///< of a triad a = b + s c, each array counted once
  double flops_per_s = 0.0;  ///< of independent fused multiply-adds in registers
};

/// By that many threads (0 = all cores), over arrays of `megabytes` each: best of several.
Ceilings cpu_ceilings(int threads, std::size_t megabytes = 96);
/// Of the GPU that kCuda uses. Errors: built without CUDA, a CUDA call failed.
Result<Ceilings> cuda_ceilings();

}  // namespace slosh::report
