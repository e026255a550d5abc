// The particles on an NVIDIA GPU. Plain C++: what includes this needs no CUDA, and where the program is built
// without it absent.cpp stands in.
#pragma once

#include <memory>

#include "sim/particle_engine.h"

namespace slosh {

/// On the GPU that `gpu` says (find_cuda_device). Errors: no such GPU, or a CUDA call that failed (not enough
/// memory, for one), in CUDA's words.
Result<std::unique_ptr<ParticleEngine>> make_cuda_engine(const RunConstants& constants,
                                                         const ParticleStart& start,
                                                         std::span<const RigidBody> bodies, int gpu);

/// variant_in_words() of a GPU that is there.
std::string cuda_variant(const Plan& plan, std::uint32_t fluid, int gpu);

}  // namespace slosh
