// edges.frag on the CPU, for renderers that are one: their shaders run every branch for every pixel, so that
// the few pixels with edges would cost all of them. Plain maths, no GL.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace slosh {

/// `rgba`: a picture as shown, eight bits a channel, any row order. Returns it with its edges smoothed;
/// `brightness` is scratch that is kept from picture to picture.
std::vector<std::uint8_t> smooth_edges(std::span<const std::uint8_t> rgba, glm::ivec2 size,
                                       std::vector<float>& brightness);

}  // namespace slosh
