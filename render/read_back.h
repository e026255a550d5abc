// Pictures and buffers from the GPU to main memory.
#pragma once

#include <glm/glm.hpp>

#include "render/gl/objects.h"
#include "render/image.h"

namespace slosh {

/// The first colour attachment, RGBA8, rows from the top down.
Image read_image(const gl::Framebuffer& target, glm::ivec2 size);

/// A colour texture as floats, 1 or 3 channels, rows from the top down.
FloatImage read_floats(const gl::Texture& texture, glm::ivec2 size, int channels);

/// The fluid's index that splat.frag put beside the front depth; −1 where there is none.
FloatImage fluid_indices(FloatImage front);

}  // namespace slosh
