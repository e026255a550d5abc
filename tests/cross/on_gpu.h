// Particles put where CUDA would have them for who draws, without a world that steps them: for benchmarks.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "sim/math/result.h"
#include "sim/math/shared_particles.h"

namespace slosh::testing {

/// A copy of them on the GPU, there while it is held. As many of either. Errors: built without CUDA, no GPU,
/// or one that exports no memory.
Result<std::shared_ptr<const SharedParticles>> put_on_gpu(std::span<const glm::vec3> positions,
                                                          std::span<const std::uint8_t> fluids);

}  // namespace slosh::testing
