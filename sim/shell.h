// Which particles of a fluid are seen from outside.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace slosh {

/// Marks with 1 each particle whose cell of a grid, 1.4 spacings wide, has a side with no fluid behind it;
/// with 0 the others and those that are retired (fluid_index 255) or not finite. A lone drop is all shell.
/// `positions` in m, `fluid_index` one a particle, `spacing` in m, > 0. One pass over the particles and one
/// over the cells that they fill; the same input gives the same result. Where the fluid is spread too wide
/// for a grid (more than 2^24 cells) everything is shell.
void find_shell(std::span<const glm::vec3> positions, std::span<const std::uint8_t> fluid_index,
                double spacing, std::vector<std::uint8_t>& shell);

}  // namespace slosh
