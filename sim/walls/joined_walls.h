// Fixed bodies that touch are one solid: a tank made of a floor and four slabs holds fluid like a tank made
// of one piece.
//
// Each for itself, a slab on a floor ends 0.7 spacings above it (its particles sit that far inside its own
// lower face too): the lowest of them pushes the first layer of fluid down, the floor gets 15 % more than the
// weight above it, and fluid leaves through the edge at coarse spacings (`slosh report error --case
// tank_faces`).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/walls/exposed_surface.h"
#include "sim/walls/particle_layer.h"

namespace slosh {

/// Particles in each body's mesh frame: its depth behind the surface of all that touch together, as far apart
/// as its surface's samples; `spacing` (m) is the fluid's. Empty for a body that touches none, which has its
/// own (wall_particles.cpp). What fills an edge between two is of the one whose face it is farther behind. A
/// face is hidden where there is another body within a quarter of a spacing in front of it.
std::vector<std::vector<LayerParticle>> joined_layers(std::span<const FixedSolid> solids, float spacing);

/// Which samples of each solid's surface no other hides, in order.
std::vector<std::vector<std::uint32_t>> exposed_samples(std::span<const FixedSolid> solids, float spacing);

}  // namespace slosh
