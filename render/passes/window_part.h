// Where in a window a picture is shown.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/passes/kept_picture.h"

namespace slosh {

/// The middle of a window of `window` pixels, in the shape of a picture of `picture` pixels: all of the
/// window where the shapes differ by rounding alone, else as much as shows the whole picture without
/// stretching it (an eye of a headset is about as high as wide, a window is not). Both at least 1 × 1.
inline PixelBox window_part(glm::ivec2 picture, glm::ivec2 window) {
  const glm::dvec2 shown(window);
  const glm::dvec2 scale = shown / glm::dvec2(picture);
  const double least = std::min(scale.x, scale.y);
  // Half a pixel of a picture that was rounded to whole ones.
  if (std::abs(scale.x - scale.y) * 0.5 * std::min(picture.x, picture.y) <= 0.51 * least)
    return {{0, 0}, window};
  const glm::ivec2 part =
      glm::clamp(glm::ivec2(glm::round(least * glm::dvec2(picture))), glm::ivec2(1), window);
  const glm::ivec2 low = (window - part) / 2;
  return {low, low + part};
}

}  // namespace slosh
