// The particles on the CPU: sorted columns, SIMD rows, a team of threads.
#pragma once

#include <memory>

#include "sim/particle_engine.h"

namespace slosh {

/// threads: in all, the caller's among them; 0 = all cores.
std::unique_ptr<ParticleEngine> make_cpu_engine(const RunConstants& constants, const ParticleStart& start,
                                                std::span<const RigidBody> bodies, int threads);

/// variant_in_words() of this processor.
std::string cpu_variant();

}  // namespace slosh
