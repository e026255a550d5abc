// The particles of a saved world, and their bonds: the end of its bytes.
#pragma once

#include "sim/saved_state.h"
#include "sim/state_bytes.h"

namespace slosh {

/// Of each particle in a saved world, without bonds.
std::size_t bytes_a_particle(const Plan& plan);
void write_particles(StateSink& s, const RunConstants& constants, const SavedState& state);
/// All that is left of `s`, with every value checked.
void read_particles(StateSource& s, const StateFrame& frame, const RunConstants& constants,
                    SavedState& state);

}  // namespace slosh
