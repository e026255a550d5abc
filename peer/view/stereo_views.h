// Both eyes of somebody who looks at a flat picture of each, side by side.
#pragma once

#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "render/frame.h"

namespace slosh {

inline constexpr float kEyesApart = 0.063f;  ///< m, between people's pupils, in the mean

/// Left and right of `middle`, `apart` m in all. They look the same way, and their pictures are shifted so
/// that what is `screen` m before them (> 0) is at one place in both: it lies in the screen, the rest before
/// it and behind.
inline std::array<View, 2> stereo_views(const View& middle, float apart, float screen) {
  std::array<View, 2> eyes{middle, middle};
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const float aside = eye == 0 ? 0.5f * apart : -0.5f * apart;  // of the world, as this eye sees it
    eyes[eye].view = glm::translate(glm::mat4(1.0f), glm::vec3(aside, 0.0f, 0.0f)) * middle.view;
    eyes[eye].projection[2][0] += middle.projection[0][0] * aside / screen;
  }
  return eyes;
}

}  // namespace slosh
