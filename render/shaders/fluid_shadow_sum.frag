// What fluid_shadow.comp summed; the sums are zero again after.
#include "sums.glsl"
layout(std430, binding = 2) buffer Sums { uint sums[]; };
uniform int size;
uniform vec3 alike;  // the channels of the first sum where it stands for all; 0: each has its own
bool pixel(ivec2 texel, out vec4 value) {
  int first = 4 * (texel.y * size + texel.x);
  vec3 dimming = vec3(float(sums[first]), float(sums[first + 1]), float(sums[first + 2])) / kDimmingSteps;
  if (alike != vec3(0.0)) dimming = dimming.r * alike;
  value = vec4(dimming, uintBitsToFloat(sums[first + 3]));
  for (int channel = 0; channel < 4; ++channel) sums[first + channel] = 0u;
  return true;
}
#include "pixel_main.glsl"
