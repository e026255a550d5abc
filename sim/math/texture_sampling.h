// How a texture is read outside its picture and between its texels: glTF's samplers.
#pragma once

#include <cmath>
#include <cstdint>

namespace slosh {

/// What lies beyond a texture's edge.
enum class TextureWrap : std::uint8_t { kRepeat, kMirror, kClamp };

/// How a texture that is seen smaller than it is is read, in glTF's order (9728, 9729, 9984–9987).
enum class TextureShrink : std::uint8_t {
  kNearest,
  kLinear,
  kNearestMipNearest,
  kLinearMipNearest,
  kNearestMipLinear,
  kLinearMipLinear,
};

struct TextureSampling {
  TextureWrap wrap_u = TextureWrap::kRepeat;
  TextureWrap wrap_v = TextureWrap::kRepeat;
  TextureShrink shrink = TextureShrink::kLinearMipLinear;
  bool nearest = false;  ///< magnified without interpolation

  bool operator==(const TextureSampling&) const = default;
};

/// The texel that stands for texel `index` (any) of a row of `size` > 0.
inline int wrapped_texel(long index, int size, TextureWrap wrap) {
  if (wrap == TextureWrap::kClamp) return static_cast<int>(index < 0 ? 0 : index >= size ? size - 1 : index);
  const long period = wrap == TextureWrap::kMirror ? 2L * size : size;
  long at = index % period;
  if (at < 0) at += period;
  return static_cast<int>(at < size ? at : period - 1 - at);
}

}  // namespace slosh
