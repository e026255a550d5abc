// What fluid_shadow.comp summed.
#include "sums.glsl"
layout(std430, binding = 2) readonly buffer Sums { uint sums[]; };
uniform int size;
bool pixel(ivec2 texel, out vec4 value) {
  int first = 4 * (texel.y * size + texel.x);
  vec3 dimming = vec3(float(sums[first]), float(sums[first + 1]), float(sums[first + 2])) / kDimmingSteps;
  value = vec4(dimming, uintBitsToFloat(sums[first + 3]));
  return true;
}
#include "pixel_main.glsl"
