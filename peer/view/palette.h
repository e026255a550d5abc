// One colour a device, the same in plots, arrows and the HUD. The first two as in the paper's Fig 11: left
// hand red, right hand blue.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <string>

namespace slosh {

struct DeviceColor {
  const char* hex;  ///< sRGB, for gnuplot
  glm::vec3 srgb;   ///< 0–1
};

inline const DeviceColor& device_color(std::size_t device) {
  static constexpr std::array<DeviceColor, 6> kColors{{{"#c8322b", {0.784f, 0.196f, 0.169f}},
                                                       {"#1f5fbf", {0.122f, 0.373f, 0.749f}},
                                                       {"#d9a300", {0.851f, 0.639f, 0.000f}},
                                                       {"#2f8f4e", {0.184f, 0.561f, 0.306f}},
                                                       {"#7b3fa0", {0.482f, 0.247f, 0.627f}},
                                                       {"#008c9e", {0.000f, 0.549f, 0.620f}}}};
  return kColors[device % kColors.size()];
}

/// To scene-linear light, as Frame's arrows and meshes want it.
inline glm::vec3 linear_color(const DeviceColor& color) {
  return glm::pow(color.srgb, glm::vec3(2.2f));
}

}  // namespace slosh
