// edges.frag on the CPU, for renderers that are one: their shaders run every branch for every pixel, so that
// the few pixels with edges would cost all of them. Plain maths, no GL.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/passes/kept_picture.h"

namespace slosh {

/// `rgba`: a picture as shown, eight bits a channel, any row order. Writes it with its edges smoothed to
/// `out`, as far as that may differ from the call before where `changed` is what changed in it. `brightness`
/// and `out` are kept from picture to picture; where they have another size all of it is written.
void smooth_edges(std::span<const std::uint8_t> rgba, glm::ivec2 size, PixelBox changed,
                  std::vector<float>& brightness, std::vector<std::uint8_t>& out);

}  // namespace slosh
