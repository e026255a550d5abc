#include "render/read_back.h"

#include <algorithm>
#include <bit>

#include "render/renderer.h"

namespace slosh {
namespace {

/// GL's rows go from the bottom up.
template <class T>
void flip_rows(std::vector<T>& values, std::size_t row) {
  for (std::size_t low = 0, high = values.size(); low + row < high; low += row) {
    high -= row;
    std::swap_ranges(values.begin() + static_cast<std::ptrdiff_t>(low),
                     values.begin() + static_cast<std::ptrdiff_t>(low + row),
                     values.begin() + static_cast<std::ptrdiff_t>(high));
  }
}

}  // namespace

Image read_image(const gl::Framebuffer& target, glm::ivec2 size) {
  Image image{size.x, size.y, {}};
  image.rgba.resize(std::size_t{4} * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  // The HUD's blending leaves alpha below one.
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  flip_rows(image.rgba, std::size_t{4} * static_cast<std::size_t>(size.x));
  return image;
}

FloatImage read_floats(const gl::Texture& texture, glm::ivec2 size, int channels) {
  FloatImage image{size.x, size.y, channels, {}};
  image.values.resize(static_cast<std::size_t>(channels) * static_cast<std::size_t>(size.x) *
                      static_cast<std::size_t>(size.y));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture.name(), 0, channels == 1 ? GL_RED : GL_RGB, GL_FLOAT,
                    static_cast<GLsizei>(image.values.size() * sizeof(float)), image.values.data());
  flip_rows(image.values, static_cast<std::size_t>(channels) * static_cast<std::size_t>(size.x));
  return image;
}

FloatImage fluid_indices(FloatImage front) {
  for (float& value : front.values) {
    const bool none = value >= 0.5f * kNoFluidDepth;
    value = none ? -1.0f : static_cast<float>(std::bit_cast<std::uint32_t>(value) & 15u);
  }
  return front;
}

}  // namespace slosh
